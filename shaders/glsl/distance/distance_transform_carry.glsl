// Propagation between the bands of a column (Cao et al. 2010, phase 1), which are its words of 32 rows: for each the nearest sites
// above and below. Inside a word, the nearest site is found by bit scans where it is needed.
#include "lib/distance_transform.glsl"

layout(local_size_x = 32) in;

void main() {
  int x = int(gl_GlobalInvocationID.x), layer = int(gl_WorkGroupID.y);
  ivec2 size = imageSize(words).xy;
  if (x >= size.x) return;
  int above = NONE_ABOVE;
  for (int w = 0; w < size.y; ++w) {
    imageStore(carries, ivec3(x, w, layer), uvec4(pack_carry(above, NONE_BELOW)));
    int last = findMSB(imageLoad(words, ivec3(x, w, layer)).x);
    if (last >= 0) above = w * WORD + last;
  }
  int below = NONE_BELOW;
  for (int w = size.y - 1; w >= 0; --w) {
    above = carry_above(imageLoad(carries, ivec3(x, w, layer)).x);
    imageStore(carries, ivec3(x, w, layer), uvec4(pack_carry(above, below)));
    int first = findLSB(imageLoad(words, ivec3(x, w, layer)).x);
    if (first >= 0) below = w * WORD + first;
  }
}
