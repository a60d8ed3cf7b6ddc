// Jump flooding, before the first step: every site knows itself (Rong and Tan 2006).
#include "lib/distance_transform.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at.xy, imageSize(nearest).xy))) return;
  uint bits = imageLoad(words, ivec3(at.x, at.y / WORD, at.z)).x;
  uint seed = (bits >> (at.y % WORD) & 1u) != 0u ? pack_site(at.xy) : NO_SITE;
  imageStore(nearest, at, uvec4(seed));
  imageStore(other, at, uvec4(seed));
}
