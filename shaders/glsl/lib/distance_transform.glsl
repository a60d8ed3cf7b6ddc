// The nearest site of a pixel, as the distance transforms store it, and the exact integer arithmetic that finds it. Pure
// functions.
//
// Whoever includes this defines WORD, the pixels a word (int, 32).
#ifndef GNOMON_DISTANCE_TRANSFORM
#define GNOMON_DISTANCE_TRANSFORM

const uint NO_SITE = 0xFFFFFFFFu;  // no site in the image, or none within the radius

uint pack_site(ivec2 site) { return uint(site.x) | uint(site.y) << 16; }
// False when there is none; `site` in pixels.
bool unpack_site(uint packed, out ivec2 site) {
  site = ivec2(packed & 0xFFFFu, packed >> 16);
  return packed != NO_SITE;
}

int square(int a) { return a * a; }
// At most 2^29 for sides up to 16384: exact in 32 bits, as a float would not be.
int squared_distance(ivec2 a, ivec2 b) { return square(a.x - b.x) + square(a.y - b.y); }

// ---- sites of a column as bits: bit i of word w of a column stands for the pixel y = WORD w + i ----

const int NONE_ABOVE = -0x4000; // rows further away than any in an image
const int NONE_BELOW = 0x8000;

// The nearest sites of a column in the words above and below a word. Rows of sites, or NONE_*.
uint pack_carry(int above, int below) { return uint(above - NONE_ABOVE) | uint(below) << 16; }
int carry_above(uint carry) { return int(carry & 0xFFFFu) + NONE_ABOVE; }
int carry_below(uint carry) { return int(carry >> 16); }

// The part of a column that a word of rows sees.
struct Column {
  uint bits, carry;
};
const Column EMPTY_COLUMN = Column(0u, uint(NONE_BELOW) << 16);  // pack_carry(NONE_ABOVE, NONE_BELOW)

// Row of the site of a column that is nearest to row `y`, which lies in the word that begins at row `first`; the upper one of two
// at the same distance. Not a row (is_row) when the column has no site.
int nearest_in_column(Column column, int first, int y) {
  uint up_to = 0xFFFFFFFFu >> uint(first + WORD - 1 - y);  // rows up to and including y
  int low = findMSB(column.bits & up_to), high = findLSB(column.bits & ~up_to);
  int above = low >= 0 ? first + low : carry_above(column.carry);
  int below = high >= 0 ? first + high : carry_below(column.carry);
  return y - above <= below - y ? above : below;
}
bool is_row(int row) { return row >= 0 && row < NONE_BELOW; }

// ---- lower envelopes of parabolas ----

// Along a row, the squared distance to the site of column s at squared vertical distance d is a parabola in x: (x - s)^2 + d. Two
// of them, s < u, cross once. Returns the largest x at which the one of s is not above the one of u (Meijster et al. 2000, Sep).
// `lift`: s^2 + d, at most 2^29, so that the difference fits 32 bits where the products of a cross-multiplied comparison would
// not. The quotient comes from a division of floats, wrong by at most one inside the image, and is then set right in integers.
// `end`: the row's length; results beyond [-1, end] only tell the side.
int last_not_above(int s, int lift_s, int u, int lift_u, int end) {
  int numerator = lift_u - lift_s, denominator = 2 * (u - s);
  int x = int(floor(clamp(float(numerator) / float(denominator), -1.0, float(end))));
  int rest = numerator - x * denominator;
  return x + (rest >= denominator ? 1 : 0) - (rest < 0 ? 1 : 0);
}

#endif
