// Patches whose silhouettes are cut: after what soft/back_projection.glsl declares.
const int PLACES = 4;  // a side, at which a tap is cut

// Along one axis: (3.5) at the places of a tap. `down`, `up`: whole taps to the silhouette's ends.
vec4 relative_places(Run down, Run up, bool lit) {
  vec4 r;
  for (int i = 0; i < PLACES; ++i) {
    float c = (float(i) + 0.5) / float(PLACES);
    r[i] = rbsm_relative_axis(run_distance(down, c), run_distance(up, 1.0 - c), lit ? 1.0 : 0.0, WINDOW);
  }
  return r;
}

// The places of a tap that are in shadow, row by row, 4 bits each (3.9). `d`: its discontinuities.
uint shadowed_places(ivec2 tap, bool lit, bvec4 d) {
  Runs runs = bit_runs(tap, lit, d);
  vec4 rx = relative_places(runs.left, runs.right, lit), ry = relative_places(runs.top, runs.bottom, lit);
  uint places = 0u;
  for (int j = 0; j < PLACES; ++j)
    for (int i = 0; i < PLACES; ++i)
      if (rbsm_nonconservative(lit, vec2(rx[i], ry[j])) == 0.0) places |= 1u << (PLACES * j + i);
  return places;
}

// Of the neighbours that are in shadow, the one that is nearest to the light; 0: none is. What is by less than a texel's width nearer
// than the receiver does not count: beside it, whether it hides anything is a matter of rounding.
float nearest_neighbour(ivec2 tap, bvec4 d) {
  vec4 m = vec4(magnification_at(tap - ivec2(1, 0)), magnification_at(tap + ivec2(1, 0)), magnification_at(tap - ivec2(0, 1)),
                magnification_at(tap + ivec2(0, 1)));
  float most = 1.0 / depth_of_texel_at(query), none = 2.0 * most;
  bvec4 counts = bvec4(d.x && m.x > 0.0 && m.x <= most, d.y && m.y > 0.0 && m.y <= most, d.z && m.z > 0.0 && m.z <= most,
                       d.w && m.w > 0.0 && m.w <= most);
  m = mix(vec4(none), m, counts);
  float found = min(min(m.x, m.y), min(m.z, m.w));
  return found < none ? found : 0.0;
}

void hide_places(ivec2 tap, uint places, float own, float left, float above) {
  vec2 low = low_of(grid, tap), part = vec2(1.0 / float(PLACES));
  for (int j = 0; j < PLACES; ++j) {
    uint row = places >> (PLACES * j) & 0xFu;
    if (row == 0u) continue;
    vec2 from = vec2(findLSB(row), j), to = vec2(findMSB(row) + 1, j + 1);
    hide_texels(low + from * part, low + to * part, own, from.x == 0.0 ? left : 0.0, j == 0 ? above : 0.0);
  }
}

// `own`: 0 where the tap is lit; `left`, `above`: of the taps there.
void hide_tap(ivec2 tap, float own, float left, float above) {
  bool lit = own == 0.0;
  bvec4 d = bit_discontinuity(tap, lit);
  bool corner = (d.x || d.y) && (d.z || d.w);  // elsewhere (3.9) is the plain test
  uint places = lit ? 0u : 0xFFFFu;
  if (corner) places = shadowed_places(tap, lit, d);
  if (lit && places != 0u) own = nearest_neighbour(tap, d);
  if (own == 0.0) places = 0u;
  if (places == 0xFFFFu) {
    vec2 low = low_of(grid, tap);
    hide_texels(low, low + 1.0, own, left, above);
  } else if (places != 0u) {
    hide_places(tap, places, own, left, above);
  }
}

// Is no tap of a row in shadow, nor of those beside it?
bool is_lit_around(int y) {
  uint all = 0xFFFFFFFFu >> (32 - window.x);
  return (rows[y + HALO - 1] & rows[y + HALO] & rows[y + HALO + 1] & all) == all;
}

void hide_fine() {
  read_window_by_quads(grid.taps);
  float above[MOST_TAPS];
  for (int x = 0; x < MOST_TAPS; ++x) above[x] = 0.0;
  int y = 0;
  do {
    if (is_lit_around(y)) continue;  // those above are lit, too
    float left = 0.0;
    int x = 0;
    do {
      ivec2 tap = ivec2(x, y);
      float own = bit_lit(tap) ? 0.0 : magnification_at(tap);
      hide_tap(tap, own, left, above[x]);
      left = above[x] = own;
    } while (++x < grid.taps.x);
  } while (++y < grid.taps.y && !is_full(mask));
}
