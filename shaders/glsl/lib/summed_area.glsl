// Sums over rectangles with fractional corners from a summed-area table (Crow 1984). Pure functions; whoever includes it defines
// SUMMED, uvec4 (integers that wrap) or vec4, and before the inclusion
//   SUMMED summed_at(ivec2 texel, int layer)   the table there: the sum of all texels up to and including this one.
//
// Beyond the map's border its last texels are repeated, as shadow tests have it.
#ifndef GNOMON_SUMMED_AREA
#define GNOMON_SUMMED_AREA

// What [begin, end) covers of a line of texels: a first texel, those between, and a last one. `ends`: where the first begins and
// ends, and the last begins and ends; `weights`: how much of the first, of those between and of the last counts.
struct SummedSpan {
  ivec4 ends;
  vec3 weights;
};

SummedSpan summed_span(float begin, float end, int size) {
  float border = float(size), from = clamp(begin, 0.0, border), to = clamp(end, 0.0, border);
  float before = min(end, 0.0) - min(begin, 0.0), behind = max(end, border) - max(begin, border);
  int first = min(int(from), size - 1), last = min(int(to), size - 1);
  if (first == last) return SummedSpan(ivec4(first, first + 1, first + 1, first + 1), vec3(to - from + before + behind, 0.0, 0.0));
  return SummedSpan(ivec4(first, first + 1, last, last + 1),
                    vec3(float(first + 1) - from + before, 1.0, to - float(last) + behind));
}

// Of all texels before a corner between texels.
SUMMED summed_before(ivec2 corner, int layer) {
  return corner.x > 0 && corner.y > 0 ? summed_at(corner - 1, layer) : SUMMED(0);
}

// Of the texels between `low` and `high`, in texels, in a table of `size` texels; those on the border count in part. Differences
// of whole numbers of texels are taken before anything is weighed: they alone are right when integers wrap.
vec4 summed_rectangle(vec2 low, vec2 high, ivec2 size, int layer) {
  SummedSpan columns = summed_span(low.x, high.x, size.x), rows = summed_span(low.y, high.y, size.y);
  SUMMED above[4];
  for (int i = 0; i < 4; ++i) above[i] = summed_before(ivec2(columns.ends[i], rows.ends[0]), layer);
  vec4 sum = vec4(0.0);
  for (int y = 0; y < 3; ++y) {
    SUMMED below[4];
    for (int i = 0; i < 4; ++i) below[i] = summed_before(ivec2(columns.ends[i], rows.ends[y + 1]), layer);
    vec4 line = vec4(0.0);
    for (int x = 0; x < 3; ++x)
      line += columns.weights[x] * vec4(below[x + 1] - below[x] - above[x + 1] + above[x]);
    sum += rows.weights[y] * line;
    for (int i = 0; i < 4; ++i) above[i] = below[i];
  }
  return sum;
}

#endif
