// The same of all blocks that a filter's window around any texel of a block may touch.
#include "lib/min_max.glsl"

layout(push_constant) uniform Push { int radius; } push;  // blocks
layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 last = imageSize(blocks).xy - 1;
  if (any(greaterThan(at.xy, last))) return;
  ivec2 from = max(at.xy - push.radius, ivec2(0)), to = min(at.xy + push.radius, last);
  vec2 range = vec2(1.0, 0.0);
  for (int y = from.y; y <= to.y; ++y)
    for (int x = from.x; x <= to.x; ++x) range = min_max_join(range, imageLoad(blocks, ivec3(x, y, at.z)).xy);
  imageStore(around, at, vec4(range, 0.0, 0.0));
}
