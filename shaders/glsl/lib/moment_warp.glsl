// Depth, linear in [0, 1] over the light's fitted range, to what pre-filtered shadow maps store. Pure functions.
#ifndef GNOMON_MOMENT_WARP
#define GNOMON_MOMENT_WARP

// Donnelly and Lauritzen 2006, eq. 1-2, of depth centred on 0: squares are a quarter as large, and so is what cancels in
// the variance.
vec2 variance_moments(float z) {
  float x = z - 0.5;
  return vec2(x, x * x);
}

// Depth in [-1, 1], as exponential variance and moment shadow maps take it: it uses the sign, which is a bit per power.
float signed_depth(float z) { return 2.0 * z - 1.0; }

// Lauritzen and McCool 2008, section 5: the two warps e^(c z) and -e^(-c z).
float positive_warp(float z, float exponent) { return exp(exponent * signed_depth(z)); }
float negative_warp(float z, float exponent) { return -exp(-exponent * signed_depth(z)); }
vec2 first_two_moments(float x) { return vec2(x, x * x); }

// Peters and Klein 2015, section 3.
vec4 four_moments(float z) {
  float x = signed_depth(z), square = x * x;
  return vec4(x, square, square * x, square * square);
}

// Peters et al. 2017, section 3.2: odd and even moments are each spread over the unit square before they are rounded to 16
// bits. The coefficients are those that map the curve (x, x^3) and (x^2, x^4) to touch all sides of it.
const float ROOT_3 = 1.7320508;
vec4 quantisation_transform(vec4 b) {
  return vec4(1.5 * b.x - 2.0 * b.z + 0.5, 4.0 * (b.y - b.w),
              0.5 * ROOT_3 * b.x - 2.0 / 9.0 * ROOT_3 * b.z + 0.5, 0.5 * (b.y + b.w));
}
vec4 inverse_quantisation_transform(vec4 q) {
  float u = q.x - 0.5, v = q.z - 0.5;
  return vec4(-u / 3.0 + ROOT_3 * v, 0.125 * q.y + q.w, -0.75 * u + 0.75 * ROOT_3 * v, -0.125 * q.y + q.w);
}

#endif
