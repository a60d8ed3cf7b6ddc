// Means over rectangles of `moments`, a summed-area table with the steps of passes/filtered/summed_area.h.
#if TABLE_INTEGER == 1
#define SUMMED uvec4
#else
#define SUMMED vec4
#endif
SUMMED summed_at(ivec2 texel, int layer) { return moments_at(texel, layer); }
#include "lib/summed_area.glsl"

vec4 mean_of_sum(vec4 sum, float area) {
#if NUMBERS == NUMBERS_INTEGER_PAIR
  sum = vec4(sum.xy + sum.zw / TABLE_STEPS, 0.0, 0.0);
#endif
  vec4 mean = sum / area;
#if TABLE_INTEGER == 1
  mean = params.least + mean * ((params.greatest - params.least) / TABLE_STEPS);
#endif
  return mean;
}

// Between two places, texels; beyond the map's border its last texels are repeated.
vec4 table_mean(vec2 low, vec2 high, int layer) {
  vec2 size = high - low;
  return mean_of_sum(summed_rectangle(low, high, textureSize(moments, 0).xy, layer), size.x * size.y);
}
// From the texel `low` to before `end`, within the map.
vec4 table_mean(ivec2 low, ivec2 end, int layer) {
  SUMMED sum = summed_before(end, layer) - summed_before(ivec2(low.x, end.y), layer) - summed_before(ivec2(end.x, low.y), layer) +
               summed_before(low, layer);
  ivec2 size = end - low;
  return mean_of_sum(vec4(sum), float(size.x * size.y));
}
