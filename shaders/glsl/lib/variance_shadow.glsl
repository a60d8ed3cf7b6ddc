// Visibility from a mean and a mean square: bounds and models of P(Z >= t) for the depth Z of what the kernel holds and the
// receiver's depth t, in the same units. Pure functions.
#ifndef GNOMON_VARIANCE_SHADOW
#define GNOMON_VARIANCE_SHADOW

float variance_of(vec2 moments, float least) { return max(moments.y - moments.x * moments.x, least); }

// Chebyshev's one-tailed bound (Donnelly and Lauritzen 2006, eq. 5); its equality is the planar case (eq. 6-9).
// `least`: smallest variance that counts, above 0.
float chebyshev_visibility(vec2 moments, float t, float least) {
  float v = variance_of(moments, least), d = max(t - moments.x, 0.0);
  return v / (v + d * d);
}

// e^(-x^2)-tail 1 - erf(x) of x >= 0: Abramowitz and Stegun 7.1.26, error below 1.5e-7.
float upper_tail(float x) {
  float t = 1.0 / (1.0 + 0.3275911 * x);
  float series = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
  return series * exp(-x * x);
}

// Gumbau et al. 2011: Z as normally distributed. Its upper tail at the mean is 1/2, which would leave every lit surface, whose
// map depth is its own, half dark. `doubled`: the tail is doubled, and the receiver is lit up to the mean, as Chebyshev's bound
// has it.
float gaussian_visibility(vec2 moments, float t, float least, bool doubled) {
  const float HALF_ROOT = 0.70710678;  // sqrt(1/2)
  float x = HALF_ROOT * (t - moments.x) * inversesqrt(variance_of(moments, least));
  float tail = upper_tail(abs(x));
  return doubled ? (x > 0.0 ? tail : 1.0) : 0.5 * (x > 0.0 ? tail : 2.0 - tail);
}

// The moments of an exponential warp span e^(4 c): divided by the larger of mean and receiver, squares neither overflow nor
// vanish. Returns the scale to multiply x by (and x^2 twice).
float warp_scale(float mean, float t) { return 1.0 / max(abs(mean), abs(t)); }
vec2 scale_moments(vec2 moments, float scale) { return vec2(moments.x * scale, moments.y * scale * scale); }

// Least variance in warped units of one in depth units (range [0, 1]), by the warp's slope 2 c |t| at the receiver
// (Lauritzen and McCool 2008, section 5).
float warped_variance(float least, float t, float exponent) {
  float slope = 2.0 * exponent * t;
  return slope * slope * least;
}

// Visibilities up to `amount` become 0 (Lauritzen 2007, GPU Gems 3, ch. 8.4).
float reduce_light_leak(float visibility, float amount) { return clamp((visibility - amount) / (1.0 - amount), 0.0, 1.0); }

#endif
