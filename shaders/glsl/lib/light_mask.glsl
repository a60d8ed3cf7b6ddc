// Which points of an area light are hidden, as bits: 16x16 points, OR-ed together rectangle by rectangle. Pure functions.
//
// Places on the light are counted in cells from 0 to 16 on both axes of its bounding rectangle, downwards in the map's sense. Point
// (i, j) lies in cell (i, j), a quarter of a cell from its middle: to the left in even rows, to the right in odd ones, up in even
// columns, down in odd ones, so that an edge along an axis meets them 32 times and not 16.
#ifndef GNOMON_LIGHT_MASK
#define GNOMON_LIGHT_MASK

const int MASK_SIDE = 16;   // cells
const int MASK_WORDS = 8;   // word w: row w in the lower half, row w + 8 in the upper one
const float MASK_EVEN = 0.25, MASK_ODD = 0.75;  // place of a point in its cell, by the other axis' number

struct LightMask {
  uint words[MASK_WORDS];  // 1: hidden
};

LightMask empty_mask() {
  LightMask mask;
  for (int w = 0; w < MASK_WORDS; ++w) mask.words[w] = 0u;
  return mask;
}

// Numbers i with low <= i + phase < high, as bits.
uint cells_between(float low, float high, float phase) {
  float side = float(MASK_SIDE);
  uint first = uint(ceil(clamp(low - phase, 0.0, side))), end = uint(ceil(clamp(high - phase, 0.0, side)));
  return end > first ? (1u << end) - (1u << first) : 0u;
}

// Rows as bits (row j: bit j) so that bits w and w + 16 are rows w and w + 8.
uint mask_rows(uint rows) { return (rows | rows << 8) & 0xFF00FFu; }

// Points of a rectangle. `even`, `odd`: columns of its points in even and in odd rows; `rows_even`, `rows_odd`: rows of its points
// in even and in odd columns.
uint mask_word(int w, uint even, uint odd, uint rows_even, uint rows_odd) {
  uint both = (rows_even >> w & 0x10001u) | (rows_odd >> w & 0x10001u) << 1;  // of a pair of columns
  return both * 0x5555u & ((w & 1) == 0 ? even : odd);
}

// Hides the points of [low.x, high.x) x [low.y, high.y).
void hide(inout LightMask mask, vec2 low, vec2 high) {
  uint even = cells_between(low.x, high.x, MASK_EVEN) * 0x10001u, odd = cells_between(low.x, high.x, MASK_ODD) * 0x10001u;
  uint rows_even = mask_rows(cells_between(low.y, high.y, MASK_EVEN)), rows_odd = mask_rows(cells_between(low.y, high.y, MASK_ODD));
  for (int w = 0; w < MASK_WORDS; ++w) mask.words[w] |= mask_word(w, even, odd, rows_even, rows_odd);
}

// Hides the points of the half plane in which `at_middle` + dot(slope, place - 8) <= 0.
void hide_half_plane(inout LightMask mask, float at_middle, vec2 slope) {
  const float MIDDLE = 0.5 * float(MASK_SIDE);
  for (int j = 0; j < MASK_SIDE; ++j) {
    uint row = 0u;
    for (int odd = 0; odd < 2; ++odd) {
      // Along the row the border lies at one place, by the height of the points in these columns.
      float y = float(j) + (odd == 0 ? MASK_EVEN : MASK_ODD) - MIDDLE;
      float rest = at_middle + slope.y * y, x = -rest / (slope.x == 0.0 ? 1.0 : slope.x) + MIDDLE;
      vec2 part = slope.x > 0.0 ? vec2(0.0, x) : slope.x < 0.0 ? vec2(x, float(MASK_SIDE)) : vec2(0.0, rest <= 0.0 ? float(MASK_SIDE) : 0.0);
      row |= cells_between(part.x, part.y, (j & 1) == 0 ? MASK_EVEN : MASK_ODD) & (odd == 0 ? 0x5555u : 0xAAAAu);
    }
    mask.words[j % MASK_WORDS] |= j < MASK_WORDS ? row : row << 16;
  }
}

bool is_full(LightMask mask) {
  uint all = mask.words[0];
  for (int w = 1; w < MASK_WORDS; ++w) all &= mask.words[w];
  return all == 0xFFFFFFFFu;
}

#endif
