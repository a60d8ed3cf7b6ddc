// The separable cross-bilateral filter with a width of its own for each pixel, one direction (Pham and van Vliet 2005; Macedo
// 2018, ch. 5.4).
#include "screen/strip_filter_line.glsl"

const float SIGMAS = 2.0;  // of the Gaussian, in half a window

float filtered(Strip strip, int place, Receiving centre, float half_width) {
  float sigma = max(half_width, 0.5) / SIGMAS, range = params.range_tolerance * centre.depth;
  float sum = source_at(pixel_of(strip, place), strip.layer), weights = 1.0;
  int reach = int(ceil(half_width));
  for (int i = -reach; i <= reach; ++i) {
    Receiving here = surface_at(strip, place + i, false);
    if (i == 0 || !here.receives) continue;
    float along = float(i) / sigma, off = dot(centre.normal, here.position - centre.position) / range;
    float weight = clamp(half_width + 1.0 - abs(float(i)), 0.0, 1.0) * exp(-0.5 * (along * along + off * off));
    sum += weight * source_at(pixel_of(strip, place + i), strip.layer);
    weights += weight;
  }
  return clamp(sum / weights, 0.0, 1.0);
}

#include "screen/strip_filter_soft.glsl"
