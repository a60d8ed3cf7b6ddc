// A square of taps as bits, lit or in shadow, so that where silhouettes end is found without walks. Pure functions, but for the bits
// themselves. Before it: `bool tap_lit(ivec2 tap)`, `vec4 quad_lit(ivec2 tap)` (the tap w, at its right z, below x,
// diagonally y), MOST_TAPS (a side), and lib/revectorization.glsl.
#ifndef GNOMON_SILHOUETTE_BITS
#define GNOMON_SILHOUETTE_BITS

#include "silhouette_window.glsl"

const int HALO = 4;                       // taps around the square, which tell where silhouettes end
const int WINDOW = MOST_TAPS + 2 * HALO;  // even, 32 at most

uint rows[WINDOW], columns[WINDOW];  // a bit a tap, from -HALO on: 1 is lit
ivec2 window;                        // taps

void read_window(ivec2 taps) {
  window = taps + 2 * HALO;
  for (int i = 0; i < WINDOW; ++i) rows[i] = columns[i] = 0u;
  int y = 0;
  do {
    int x = 0;
    uint row = 0u;
    do {
      uint lit = tap_lit(ivec2(x, y) - HALO) ? 1u : 0u;
      row |= lit << x;
      columns[x] |= lit << y;
    } while (++x < window.x);
    rows[y] = row;
  } while (++y < window.y);
}

// The same by quads: fewer reads, where taps are neighbours in the map.
void read_window_by_quads(ivec2 taps) {
  window = taps + 2 * HALO;
  for (int i = 0; i < WINDOW; ++i) rows[i] = columns[i] = 0u;
  int y = 0;
  do {
    int x = 0;
    do {
      uvec4 lit = uvec4(quad_lit(ivec2(x, y) - HALO));
      rows[y] |= (lit.w | lit.z << 1) << x;
      rows[y + 1] |= (lit.x | lit.y << 1) << x;
      columns[x] |= (lit.w | lit.x << 1) << y;
      columns[x + 1] |= (lit.z | lit.y << 1) << y;
    } while ((x += 2) < window.x);
  } while ((y += 2) < window.y);
}

bool bit_lit(ivec2 tap) { return (rows[tap.y + HALO] >> (tap.x + HALO) & 1u) != 0u; }

// (3.3)
bvec4 bit_discontinuity(ivec2 tap, bool lit) {
  int x = tap.x + HALO, y = tap.y + HALO;
  uint row = rows[y], column = columns[x], own = uint(lit);
  return bvec4((row >> (x - 1) & 1u) != own, (row >> (x + 1) & 1u) != own, (column >> (y - 1) & 1u) != own,
               (column >> (y + 1) & 1u) != own);
}

struct Runs {
  Run left, right, top, bottom;
};
// Along the silhouettes of a tap whose discontinuities are `d`.
Runs bit_runs(ivec2 tap, bool lit, bvec4 d) {
  int x = tap.x + HALO, y = tap.y + HALO;
  uint row = rows[y], column = columns[x];
  uint up = row ^ rows[y - 1], down = row ^ rows[y + 1], left = column ^ columns[x - 1], right = column ^ columns[x + 1];
  uint same_row = lit ? row : ~row, same_column = lit ? column : ~column;
  uint shares_row = (d.z ? up : 0u) | (d.w ? down : 0u), shares_column = (d.x ? left : 0u) | (d.y ? right : 0u);
  return Runs(run_down(same_row, shares_row, x, 0u, d.z, d.w, WINDOW), run_up(same_row, shares_row, x, window.x, 0u, d.z, d.w, WINDOW),
              run_down(same_column, shares_column, y, 0u, d.x, d.y, WINDOW),
              run_up(same_column, shares_column, y, window.y, 0u, d.x, d.y, WINDOW));
}

#endif
