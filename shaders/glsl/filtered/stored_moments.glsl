// What a filtered map holds, as the solvers of lib/ take it.
#include "lib/moment_warp.glsl"
#include "lib/variance_shadow.glsl"
#include "lib/moment_shadow.glsl"
#include "lib/convolution_shadow.glsl"

#if BASIS == BASIS_FOURIER
const int SERIES_LAYERS = MOMENT_LAYERS;
#elif BASIS == BASIS_FOURIER_DEPTH  // the series, and the same times depth
const int SERIES_LAYERS = MOMENT_LAYERS / 2;
#endif

#if BASIS == BASIS_FOUR_MOMENTS
// `centre`: HAMBURGER_CENTRE or HAUSDORFF_CENTRE.
vec4 biased_moments(vec4 stored, vec4 centre) {
  vec4 m = PRECISION == PRECISION_HALF ? inverse_quantisation_transform(stored) : stored;
  return bias_moments(m, centre, params.moment_bias * (PRECISION == PRECISION_HALF ? HALF_MOMENT_BIAS : SINGLE_MOMENT_BIAS));
}
#endif

// How much farther, in linear depth, the receiver's plane is half a kernel away along x and along y.
vec2 linear_rise(Query query, vec2 half_width) {
  Receiver plane = query.plane;
  float z = receiver_depth(query.view, plane, plane.texel, true);
  return vec2(receiver_depth(query.view, plane, plane.texel + vec2(half_width.x, 0.0), true),
              receiver_depth(query.view, plane, plane.texel + vec2(0.0, half_width.y), true)) - z;
}
