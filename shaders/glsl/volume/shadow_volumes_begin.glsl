// Copies the camera's depth, to the bit, and lights the background; the rest is in shadow until resolved.
#include "volume/shadow_volumes.glsl"

layout(location = 0) out float out_visibility;

void main() {
  float device_depth = depth_at(ivec2(gl_FragCoord.xy)).x;
  gl_FragDepth = device_depth;
  out_visibility = is_background(device_depth) ? 1.0 : 0.0;
}
