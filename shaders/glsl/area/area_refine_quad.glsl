// Second pass of algorithm 6's refinement test, a fragment for 32 pixels of a row: discards unless one of them shows banding,
// that is, lies in the quad's penumbra but on no soft discontinuity, and so do its eight neighbours with the same sum. An
// occlusion query counts the rest.
#include "frame/frame.glsl"
#include "area/area_words.glsl"
#include "lib/shadow_sum.glsl"

// `slots`: the quad's samples. `stride`: the test's window is every stride-th pixel, with neighbours as far away (6.6-6.7).
layout(push_constant) uniform Push { uvec4 slots; uint stride; } push;

struct Pixels {
  ShadowSum sum;
  uint soft;
};

uvec4 bits_of(uint row, uint word, bool edges) {
  uvec4 bits;
  for (int k = 0; k < 4; ++k) {
    uint place = plane_place(push.slots[k], row, word);
    bits[k] = edges ? edge_planes[place] : lit_planes[place];
  }
  return bits;
}

Pixels pixels_at(uint row, uint word) {
#if TEST == TEST_PCF
  return Pixels(shadow_sum(bits_of(row, word, false)), 0u);
#else
  return Pixels(shadow_sum(bits_of(row, word, false)), at_least(shadow_sum(bits_of(row, word, true)), params.soft_discontinuity));
#endif
}

uint moved_right(uint here, uint before) { return here << push.stride | before >> (32u - push.stride); }
uint moved_left(uint here, uint after) { return here >> push.stride | after << (32u - push.stride); }
Pixels right(Pixels here, Pixels before) {
  return Pixels(ShadowSum(moved_right(here.sum.ones, before.sum.ones), moved_right(here.sum.twos, before.sum.twos),
                          moved_right(here.sum.fours, before.sum.fours)), moved_right(here.soft, before.soft));
}
Pixels left(Pixels here, Pixels after) {
  return Pixels(ShadowSum(moved_left(here.sum.ones, after.sum.ones), moved_left(here.sum.twos, after.sum.twos),
                          moved_left(here.sum.fours, after.sum.fours)), moved_left(here.soft, after.soft));
}

// Pixels [0, count) of a word.
uint first_pixels(int count) { return count >= 32 ? 0xFFFFFFFFu : count <= 0 ? 0u : (1u << count) - 1u; }

// Every stride-th pixel of the image's row, in this word.
uint window(uint word) {
  uint pixels = 0u;
  uint first = (push.stride - 32u * word % push.stride) % push.stride;
  for (uint i = first; i < 32u; i += push.stride) pixels |= 1u << i;
  return pixels;
}

void main() {
  uint word = uint(gl_FragCoord.x), row = uint(gl_FragCoord.y) * push.stride;
  int width = int(frame.viewport.x), stride = int(push.stride);
  int first = 32 * int(word);
  Pixels centre = pixels_at(row, word);
  uint banding = in_penumbra(centre.sum) & ~centre.soft & window(word) & first_pixels(width - first);
  // Pixels that have a neighbour to their left and to their right.
  uint has_left = ~first_pixels(stride - first), has_right = first_pixels(width - stride - first);
  uint last_word = words_a_row() - 1u;
  int iterations = banding != 0u ? 3 : 0;  // a loop of no iterations is what costs least where there is nothing to do
  for (int i = 0; i < iterations; ++i) {
    int y = int(row) + (i - 1) * stride;
    if (y < 0 || y >= int(frame.viewport.y)) continue;
    Pixels here = pixels_at(uint(y), word);
    Pixels before = pixels_at(uint(y), max(word, 1u) - 1u), after = pixels_at(uint(y), min(word + 1u, last_word));
    Pixels l = right(here, before), r = left(here, after);
    banding &= ~(differs(here.sum, centre.sum) | here.soft);
    banding &= ~(has_left & (differs(l.sum, centre.sum) | l.soft));
    banding &= ~(has_right & (differs(r.sum, centre.sum) | r.soft));
  }
  if (banding == 0u) discard;
}
