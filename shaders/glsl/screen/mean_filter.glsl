// The edge-aware separable mean filter (Macedo 2018, ch. 4.2.3, eq. 4.4-4.5), one direction: running sums along the strip's
// lines, so that a pixel's mean is the difference of two, whatever the width.
#include "screen/strip_filter_line.glsl"
#include "screen/mean_filter_edge.glsl"

// Sums are integers, which add up exactly in any order and may wrap: 2^24 a unit of visibility is the precision of its float.
const float UNIT = 16777216.0;

const int PART = SPAN / PARTS;  // places of a part: as many as a word has bits

shared uint sums[SPAN * LINES];     // of a part of a line, up to and including each place
shared uint totals[PARTS * LINES];  // of the whole parts
shared uint edges[PARTS * LINES];   // bit p of a part: there is an edge between its place p and the one before
shared float depths[SPAN * LINES];  // along the view axis

// What an invocation reads of its line again and again.
uint before_part[PARTS];  // sum of the parts before each
uint edge_window[4];      // words of edges, from the one before that of the first place on

void sum_part(Strip strip) {
  int first = part() * PART, end = min(first + PART, strip.places);
  if (!any_needed(strip, first, end)) end = first;
  Receiving before = surface_at(strip, first - 1, false);
  uint sum = 0u, found = 0u;
  for (int place = first; place < end; ++place) {
    Receiving here = surface_at(strip, place, is_own(strip, place));
    if (edge_between(before, here)) found |= 1u << place - first;
    sum += uint(source_at(pixel_of(strip, place), strip.layer) * UNIT + 0.5);
    sums[place * LINES + line()] = sum;
    depths[place * LINES + line()] = here.depth;
    before = here;
  }
  totals[part() * LINES + line()] = sum;
  if (end == first) sums[(first + PART - 1) * LINES + line()] = 0u;  // a window may begin right behind it
  edges[part() * LINES + line()] = found;
}

// There are none beyond the line.
uint edges_of(int part) { return part >= 0 && part < PARTS ? edges[part * LINES + line()] : 0u; }

void load_sums() {
  uint sum = 0u;
  for (int p = 0; p < PARTS; ++p) {
    before_part[p] = sum;
    sum += totals[p * LINES + line()];
  }
}

// `first`: place of the cell's first pixel.
void load_edges(int first) {
  for (int i = 0; i < 4; ++i) edge_window[i] = edges_of(first / PART + i - 1);
}

uint before(int p) {
  uint sum = 0u;
  for (int i = 1; i < PARTS; ++i)
    if (i == p) sum = before_part[i];
  return sum;
}

// Of all places of the line up to and including `place`, which may be -1.
uint sum_to(int place) { return place < 0 ? 0u : sums[place * LINES + line()] + before(place / PART); }

// The 32 bits of edges that end with that of `place`, which becomes bit 31; `word`: that of the place in edge_window.
uint edges_up_to(int place, int word) {
  uint shift = uint(place % PART);
  uint low = word == 1 ? edge_window[0] : word == 2 ? edge_window[1] : edge_window[2];
  uint high = word == 1 ? edge_window[1] : word == 2 ? edge_window[2] : edge_window[3];
  return high << (31u - shift) | (low >> shift) >> 1;
}

// `first`: place of the cell's first pixel.
float mean(int place, int first, float half_width) {
  int whole = int(half_width), limit = whole + 1;
  float part = half_width - float(whole);
  int word = place / PART - first / PART + 1;
  // The window begins at the last edge and ends before the next one; no edge is 32 places away, as far as `limit` at most.
  int begin = place - min(31 - findMSB(edges_up_to(place, word)), limit);
  uint ahead = edges_up_to(place + PART, word + 1);
  int end = place + min(ahead != 0u ? findLSB(ahead) : PART, limit);
  int inner_begin = max(begin, place - whole), inner_end = min(end, place + whole);
  float sum = float(sum_to(inner_end) - sum_to(inner_begin - 1));
  float outer = float(sum_to(end) - sum_to(begin - 1)) - sum;
  float weight = float(inner_end - inner_begin + 1) + part * float(end - begin - (inner_end - inner_begin));
  return clamp((sum + part * outer) / (UNIT * weight), 0.0, 1.0);
}

void filter_cell(Strip strip, int cell) {
  int first = strip.reach + 1 + cell * CELL;
  bool needed = is_needed(strip, cell), filtered = needed && changes_along(strip, cell);
  load_edges(first);
  int place = first;
  if (filtered) {
    do {
      store(pixel_of(strip, place), strip.layer, mean(place, first, half_width(depths[place * LINES + line()])));
    } while (++place < first + CELL);
  }
#ifndef ALONG_Y_AXIS  // where all that is needed is filtered
  else if (needed) {
    do {
      ivec2 pixel = pixel_of(strip, place);
      store(pixel, strip.layer, source_at(pixel, strip.layer));
    } while (++place < first + CELL);
  }
#endif
}

void main() {
  Strip strip = strip_of_workgroup();
  sum_part(strip);
  barrier();
  load_sums();
  int cell = part();
  do {
    filter_cell(strip, cell);
  } while ((cell += PARTS) < STRIP);
}
