// Visibility of a light that throws no shadow on what the camera sees: what no shadow map decides about.
#include "frame/frame.glsl"
#include "lib/octahedral.glsl"
#include "frame/pixel_state.glsl"

layout(push_constant) uniform Push { uint light; } push;
layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(visibility).xy))) return;
  float device_depth = depth_at(at).x;
  vec3 p = relative_position(at, device_depth), n = octahedral_decode(geometric_at(at).xy);
  bool away = !is_background(device_depth) && !faces_light(lights[push.light], p, n);
  imageStore(visibility, ivec3(at, push.light), vec4(unmapped_visibility(away ? PIXEL_AWAY : PIXEL_OUTSIDE)));
}
