// Is a window of the map all lit or all in umbra? After map/light_kernel.glsl, with a `pyramid`.
const int FEW = 12;  // texels a side, that are read one by one where the pyramid does not tell

// Of the texels from `low` to `high`. The pyramid's blocks reach further, and a slope rises above the map in them.
int plain_window(Query query, ivec2 low, ivec2 high) {
  int plain = min_max_compare(plane_range(query, low, high), pyramid_range(low, high, query.layer));
  if (plain != MIXED || any(greaterThanEqual(high - low, ivec2(FEW)))) return plain;
  float lit = 0.0, tests = 0.0;
  int y = low.y;
  do {
    int x = low.x;
    do {
      lit += dot(lit_quad(query, ivec2(x, y)), vec4(1.0));
      tests += 4.0;
    } while ((x += 2) <= high.x && (lit == 0.0 || lit == tests));
  } while ((y += 2) <= high.y && (lit == 0.0 || lit == tests));
  return lit == 0.0 ? PLAINLY_DARK : lit == tests ? PLAINLY_LIT : MIXED;
}
