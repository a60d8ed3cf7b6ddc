// The separable cross-bilateral filter (Pham and van Vliet 2005; Macedo 2018, ch. 5): a Gaussian over the window, each tap
// weighted too by how near it lies to the receiver's tangent plane. A strip's values are read once, whatever the width.
#include "screen/strip_filter_line.glsl"

shared float values[SPAN * LINES];
shared vec3 positions[SPAN * LINES];
const int BITS = 32;  // of a word
const int WORDS = (SPAN + BITS - 1) / BITS;
shared uint receives[LINES * WORDS];  // a bit a place

const float SIGMAS = 2.0;  // of the Gaussian, in half a window

void load_part(Strip strip) {
  for (int place = part(); place < strip.places; place += PARTS) {
    ivec2 pixel = pixel_of(strip, place);
    Receiving here = surface_at(strip, place, is_own(strip, place));
    values[place * LINES + line()] = source_at(pixel, strip.layer);
    positions[place * LINES + line()] = here.position;
    if (here.receives) atomicOr(receives[line() * WORDS + place / BITS], 1u << uint(place % BITS));
  }
}

float bilateral(int place, Receiving centre) {
  float width = half_width(centre.depth), sigma = max(width, 0.5) / SIGMAS;
  float range = params.range_tolerance * centre.depth;
  float sum = 0.0, weights = 0.0;
  for (int i = -int(ceil(width)); i <= int(ceil(width)); ++i) {
    int tap = place + i;
    bool counts = i == 0 || (receives[line() * WORDS + tap / BITS] >> uint(tap % BITS) & 1u) != 0u;
    float off = dot(centre.normal, positions[tap * LINES + line()] - centre.position) / range;
    float along = float(i) / sigma, inside = clamp(width + 1.0 - abs(float(i)), 0.0, 1.0);
    float weight = i == 0 ? 1.0 : counts ? inside * exp(-0.5 * (along * along + off * off)) : 0.0;
    if (weight == 0.0) continue;  // what does not count may not even be a number
    sum += weight * values[tap * LINES + line()];
    weights += weight;
  }
  return clamp(sum / weights, 0.0, 1.0);
}

void filter_cell(Strip strip, int cell) {
  int first = strip.reach + 1 + cell * CELL;
  for (int place = first; place < first + (is_needed(strip, cell) ? CELL : 0); ++place) {
    ivec2 pixel = pixel_of(strip, place);
    Receiving here = surface_at(strip, place, false);
    float v = here.receives ? bilateral(place, here) : values[place * LINES + line()];
    store(pixel, strip.layer, v);
  }
}

void main() {
  Strip strip = strip_of_workgroup();
  for (int i = int(gl_LocalInvocationIndex); i < LINES * WORDS; i += LINES * PARTS) receives[i] = 0u;
  barrier();
  load_part(strip);
  barrier();
  for (int cell = part(); cell < STRIP; cell += PARTS) filter_cell(strip, cell);
}
