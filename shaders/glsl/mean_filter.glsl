// The edge-aware separable mean filter (Macedo 2018, ch. 4.2.3, eq. 4.4-4.5), one direction: running sums along the strip's
// lines, so that a pixel's mean is the difference of two, whatever the width.
#include "strip_filter_line.glsl"

// Sums are integers, which add up exactly in any order and may wrap: 2^24 a unit of visibility is the precision of its float.
const float UNIT = 16777216.0;

shared uint sums[SPAN * LINES];    // of a part of a line, up to and including each place
shared uint totals[PARTS * LINES]; // of the whole parts

const int PART = SPAN / PARTS;  // places of a part: a power of two

void sum_part(ivec2 origin, int light, int reach, int places) {
  int first = part() * PART;
  Receiving before = receiving_at(pixel_of(origin, reach, first - 1), light);
  uint sum = 0u;
  for (int place = first; place < min(first + PART, places); ++place) {
    ivec2 pixel = pixel_of(origin, reach, place);
    Receiving here = receiving_at(pixel, light);
    if (edge_between(before, here)) set_edge(place);
    sum += uint(source_at(pixel, light) * UNIT + 0.5);
    sums[place * LINES + line()] = sum;
    before = here;
  }
  totals[part() * LINES + line()] = sum;
}

// Each part's sum becomes that of the parts before it.
void add_up_totals() {
  uint sum = 0u;
  for (int p = 0; p < PARTS; ++p) {
    uint total = totals[p * LINES + line()];
    totals[p * LINES + line()] = sum;
    sum += total;
  }
}

// Of all places of the line up to and including `place`, which may be -1.
uint sum_to(int place) { return place < 0 ? 0u : sums[place * LINES + line()] + totals[place / PART * LINES + line()]; }

float mean(int place, float half_width) {
  int whole = int(half_width);
  float part = half_width - float(whole);
  int begin = window_begin(place, whole + 1), end = window_end(place, whole + 1);
  int inner_begin = max(begin, place - whole), inner_end = min(end, place + whole);
  float sum = float(sum_to(inner_end) - sum_to(inner_begin - 1));
  float outer = float(sum_to(end) - sum_to(begin - 1)) - sum;
  float weight = float(inner_end - inner_begin + 1) + part * float(end - begin - (inner_end - inner_begin));
  return clamp((sum + part * outer) / (UNIT * weight), 0.0, 1.0);
}

void main() {
  ivec2 origin;
  int light;
  bool listed = strip_at(origin, light);
  int reach = int(control[REACH]), places = listed ? LENGTH + 2 * reach + 2 : 0;
  clear_edges();
  barrier();
  sum_part(origin, light, reach, places);
  barrier();
  if (part() == 0) add_up_totals();
  barrier();
  int first = reach + 1 + part() * CELL;
  bool needed = listed && changes(origin + ALONG * part() * CELL, light);
  for (int place = first; place < first + (needed ? CELL : 0); ++place) {
    ivec2 pixel = pixel_of(origin, reach, place);
    store(pixel, light, mean(place, half_width(receiving_at(pixel, light).depth)));
  }
#ifndef ALONG_Y_AXIS
  for (int place = first; place < first + (listed && !needed ? CELL : 0); ++place) {
    ivec2 pixel = pixel_of(origin, reach, place);
    store(pixel, light, source_at(pixel, light));
  }
#endif
}
