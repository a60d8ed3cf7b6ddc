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
#if LISTED
    uint bits = imageLoad(tested, ivec3(x, w, layer)).x;
#else
    uint bits = imageLoad(words, ivec3(x, w, layer)).x;
#endif
    imageStore(words, ivec3(x, w, layer), uvec4(bits, pack_carry(above, NONE_BELOW), 0u, 0u));
    int last = findMSB(bits);
    if (last >= 0) above = w * WORD + last;
  }
  int below = NONE_BELOW;
  for (int w = size.y - 1; w >= 0; --w) {
    uvec2 word = imageLoad(words, ivec3(x, w, layer)).xy;
    imageStore(words, ivec3(x, w, layer), uvec4(word.x, pack_carry(carry_above(word.y), below), 0u, 0u));
    int first = findLSB(word.x);
    if (first >= 0) below = w * WORD + first;
  }
}
