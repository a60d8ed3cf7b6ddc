// Least and greatest depth of each block of a shadow map. Beyond the border its last texels are repeated.
#include "lib/min_max.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at.xy, imageSize(blocks).xy))) return;
  vec2 size = vec2(textureSize(shadow_map, 0).xy);
  vec2 range = vec2(1.0, 0.0);
  for (int i = 0; i < MIN_MAX_BLOCK * MIN_MAX_BLOCK / 4; ++i) {
    ivec2 corner = MIN_MAX_BLOCK * at.xy + 2 * ivec2(i % (MIN_MAX_BLOCK / 2), i / (MIN_MAX_BLOCK / 2)) + 1;
    range = min_max_join(range, min_max_of(textureGather(shadow_map, vec3(min(vec2(corner), size) / size, at.z))));
  }
  imageStore(blocks, at, vec4(range, 0.0, 0.0));
}
