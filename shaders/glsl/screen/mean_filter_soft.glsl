// The edge-aware separable mean filter with a width of its own for each pixel, one direction: Macedo 2018, ch. 5.3, with the
// penumbra's width in (4.4).
#include "screen/strip_filter_line.glsl"
#include "screen/mean_filter_edge.glsl"

// x: sum of what lies in the window on one side of the pixel, up to the surface's edge; y: its weight.
vec2 side_of(Strip strip, int place, int step, Receiving before, float half_width) {
  vec2 sum = vec2(0.0);
  for (int i = 1; float(i) < half_width + 1.0; ++i) {
    Receiving here = surface_at(strip, place + step * i, false);
    if (edge_between(before, here)) break;
    float weight = min(half_width + 1.0 - float(i), 1.0);
    sum += weight * vec2(source_at(pixel_of(strip, place + step * i), strip.layer), 1.0);
    before = here;
  }
  return sum;
}

float filtered(Strip strip, int place, Receiving centre, float half_width) {
  vec2 sum = vec2(source_at(pixel_of(strip, place), strip.layer), 1.0);
  sum += side_of(strip, place, -1, centre, half_width) + side_of(strip, place, 1, centre, half_width);
  return clamp(sum.x / sum.y, 0.0, 1.0);
}

#include "screen/strip_filter_soft.glsl"
