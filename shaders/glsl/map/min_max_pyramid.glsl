// One level of a min-max pyramid: the first from the map, every other from the level before. Levels are half as large, rounded
// down as mip levels are; where that leaves a row or a column over, the last blocks take it in, so that every texel of the map
// is in a block of every level (lib/min_max.glsl).
#include "lib/min_max.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

#if LEVEL == 0
// Beyond the border the map's last texels are repeated.
vec2 range_of(ivec3 at) {
  vec2 size = vec2(textureSize(shadow_map, 0).xy);
  return min_max_of(textureGather(shadow_map, vec3(min(vec2(2 * at.xy + 1), size) / size, at.z)));
}
#else
vec2 range_of(ivec3 at) {
  ivec2 last = imageSize(pyramid[LEVEL]).xy - 1, last_before = imageSize(pyramid[LEVEL - 1]).xy - 1;
  ivec2 from = 2 * at.xy, to = mix(min(from + 1, last_before), last_before, equal(at.xy, last));
  vec2 range = vec2(1.0, 0.0);
  for (int y = from.y; y <= to.y; ++y)
    for (int x = from.x; x <= to.x; ++x) range = min_max_join(range, imageLoad(pyramid[LEVEL - 1], ivec3(x, y, at.z)).xy);
  return range;
}
#endif

#if PYRAMID_LEVELS == 1
#define THIS_LEVEL pyramid
#else
#define THIS_LEVEL pyramid[LEVEL]
#endif

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at.xy, imageSize(THIS_LEVEL).xy))) return;
  imageStore(THIS_LEVEL, at, vec4(range_of(at), 0.0, 0.0));
}
