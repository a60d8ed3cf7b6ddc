// What hides some of the light, from means over a part of the map: the share of it that is nearer than the receiver, and that
// share's mean depth. Depth is linear in [0, 1] over the light's fitted range. Pure functions. After lib/variance_shadow.glsl,
// lib/moment_shadow.glsl and lib/moment_warp.glsl.
//
// All return x: the share; y: the share times its mean depth. What is not nearer counts as the receiver's own plane, whose mean
// depth there is t.
#ifndef GNOMON_MOMENT_OCCLUDERS
#define GNOMON_MOMENT_OCCLUDERS

const vec2 NO_OCCLUDERS = vec2(0.0);

// z_b = (mu - p t) / (1 - p), with p by Chebyshev (Yang et al. 2010, eq. 6; Macedo 2018, ch. 2.5.1): mu - v / (t - mu), without the
// difference of near numbers. `moments`: of z - 1/2.
vec2 variance_occluders(vec2 moments, float t, float least) {
  float v = variance_of(moments, least), nearer = t - 0.5 - moments.x;
  if (nearer <= 0.0) return NO_OCCLUDERS;
  float share = nearer * nearer / (v + nearer * nearer);
  return share * vec2(1.0, clamp(moments.x + 0.5 - v / nearer, 0.0, t));
}

// The points nearer than t of the distribution on three points, one of them t, that has these moments (Peters et al. 2017,
// section 5). `b`: of depth in [-1, 1], biased.
vec2 four_moment_occluders(vec4 b, float t) {
  float z = signed_depth(t);
  vec2 points = other_points(b, z);
  if (z <= points.x) return NO_OCCLUDERS;
  float first = weight_of(points.x, z, points.y, b), second = z <= points.y ? 0.0 : weight_of(points.y, z, points.x, b);
  first = clamp(first, 0.0, 1.0);
  second = clamp(second, 0.0, 1.0 - first);
  vec2 depths = clamp(0.5 + 0.5 * points, vec2(0.0), vec2(t));
  return vec2(first + second, first * depths.x + second * depths.y);
}

// Weights of occluders 1 - e^(-c (t - z)), their soft complement of the exponential test (Shen et al. 2013). `means`: of
// e^(c (z - 1)), z e^(c (z - 1)) and z. `plane`: the mean of e^(c (z - 1)) over the receiver's plane.
vec2 exponential_occluders(vec3 means, float t, float plane) {
  float share = 1.0 - means.x / plane;
  if (share <= 0.0) return NO_OCCLUDERS;
  return vec2(share, clamp(means.z - means.y / plane, 0.0, share * t));
}

// The complement of the series' test, doubled and cut off as the test itself (Annen et al. 2008, eq. 9). `test`: sums of the
// filtered terms, and of those times depth.
vec2 fourier_occluders(vec2 test, float t) {
  float share = clamp(-2.0 * test.x, 0.0, 1.0);  // 1 - 2 (1/2 + test)
  return share * vec2(1.0, clamp(share > 0.0 ? -2.0 * test.y / share : t, 0.0, t));
}

// The mean of e^(c x) over -r <= x <= r, from c r: sinh(c r) / (c r).
float mean_of_exponential(float reach) {
  float x = abs(reach);
  return x < 1e-2 ? 1.0 + x * x / 6.0 : sinh(min(x, 80.0)) / min(x, 80.0);
}

#endif
