// Pixels in no volume (the stencil test lets only these through) are lit where they face the light.
#include "volume/shadow_volumes.glsl"
#include "lib/octahedral.glsl"

layout(location = 0) out float out_visibility;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float device_depth = depth_at(at).x;
  vec3 n = octahedral_decode(geometric_at(at).xy);
  bool lit = is_background(device_depth) || faces_light(lights[push.light], relative_position(at, device_depth), n);
  out_visibility = lit ? 1.0 : 0.0;
}
