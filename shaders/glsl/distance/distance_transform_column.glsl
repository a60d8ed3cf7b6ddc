// Column `x` of the image as it is seen from the rows of `word`.
#include "lib/distance_transform.glsl"

Column load_column(int x, int word, int layer) {
  ivec3 at = ivec3(x, word, layer);
  return Column(imageLoad(words, at).x, imageLoad(carries, at).x);
}
