// The separable cross-bilateral filter (Pham and van Vliet 2005; Macedo 2018, ch. 5): a Gaussian over the window, each tap
// weighted too by how near it lies to the receiver's tangent plane. A strip's values are read once, whatever the width.
#include "strip_filter_line.glsl"

shared float values[SPAN * LINES];
shared vec3 positions[SPAN * LINES];
shared uint receives[LINES * EDGE_WORDS];  // a bit a place

const float SIGMAS = 2.0;  // of the Gaussian, in half a window

void load_part(ivec2 origin, int light, int reach, int places) {
  for (int place = part(); place < places; place += PARTS) {
    ivec2 pixel = pixel_of(origin, reach, place);
    Receiving here = receiving_at(pixel, light);
    values[place * LINES + line()] = source_at(pixel, light);
    positions[place * LINES + line()] = here.position;
    if (here.receives) atomicOr(receives[line() * EDGE_WORDS + place / BITS], 1u << uint(place % BITS));
  }
}

float bilateral(int place, Receiving centre) {
  float width = half_width(centre.depth), sigma = max(width, 0.5) / SIGMAS;
  float range = params.range_tolerance * centre.depth;
  float sum = 0.0, weights = 0.0;
  for (int i = -int(ceil(width)); i <= int(ceil(width)); ++i) {
    int tap = place + i;
    bool counts = i == 0 || (receives[line() * EDGE_WORDS + tap / BITS] >> uint(tap % BITS) & 1u) != 0u;
    float off = dot(centre.normal, positions[tap * LINES + line()] - centre.position) / range;
    float along = float(i) / sigma, inside = clamp(width + 1.0 - abs(float(i)), 0.0, 1.0);
    float weight = i == 0 ? 1.0 : counts ? inside * exp(-0.5 * (along * along + off * off)) : 0.0;
    sum += weight * values[tap * LINES + line()];
    weights += weight;
  }
  return clamp(sum / weights, 0.0, 1.0);
}

void main() {
  ivec2 origin;
  int light;
  bool listed = strip_at(origin, light);
  int reach = int(control[REACH]), places = listed ? LENGTH + 2 * reach + 2 : 0;
  for (int i = int(gl_LocalInvocationIndex); i < LINES * EDGE_WORDS; i += LINES * PARTS) receives[i] = 0u;
  barrier();
  load_part(origin, light, reach, places);
  barrier();
  int first = reach + 1 + part() * CELL;
  for (int place = first; place < first + (listed ? CELL : 0); ++place) {
    ivec2 pixel = pixel_of(origin, reach, place);
    Receiving here = receiving_at(pixel, light);
    float v = here.receives ? bilateral(place, here) : values[place * LINES + line()];
    store(pixel, light, v);
  }
}
