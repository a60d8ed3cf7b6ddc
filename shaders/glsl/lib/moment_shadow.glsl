// Moment shadow mapping with four moments (Peters and Klein 2015): the least possible share of occluders nearer than the
// receiver, given the mean of z, z^2, z^3, z^4 over the kernel, depth in [-1, 1]. Pure functions.
#ifndef GNOMON_MOMENT_SHADOW
#define GNOMON_MOMENT_SHADOW

// Rounding can leave moments that no distribution has. They are moved by `bias` towards those of a distribution for which a
// solver is as far from that as it gets (Peters and Klein 2015, section 3.3): Hamburger, the symmetric one on -1, 0, 1 whose
// Hankel matrix has the largest least eigenvalue; Hausdorff, that of density 1/sqrt(1 - z^2), the middle of the moment space.
const vec4 HAMBURGER_CENTRE = vec4(0.0, 0.63, 0.0, 0.63);
const vec4 HAUSDORFF_CENTRE = vec4(0.0, 0.5, 0.0, 0.375);
const float SINGLE_MOMENT_BIAS = 3e-7, HALF_MOMENT_BIAS = 6e-5;  // for 32-bit floats, for 16 quantised bits
vec4 bias_moments(vec4 b, vec4 centre, float bias) { return mix(b, centre, bias); }

const float SMALLEST_PIVOT = 1e-12;  // of a Cholesky factor; depth range to the fourth and less

// Algorithm 3, steps 1-3: where the two other points of the three-point distribution lie that has these moments and a point at
// z. x is the smaller.
vec2 other_points(vec4 b, float z) {
  float d22 = max(b.y - b.x * b.x, SMALLEST_PIVOT);
  float l32_d22 = b.z - b.x * b.y;
  float l32 = l32_d22 / d22;
  float d33 = max(b.w - b.y * b.y - l32 * l32_d22, SMALLEST_PIVOT);
  vec3 c = vec3(1.0, z - b.x, 0.0);
  c.z = (z * z - b.y - l32 * c.y) / d33;
  c.y = c.y / d22 - l32 * c.z;
  c.x = 1.0 - c.y * b.x - c.z * b.y;
  // A vanishing square term means a point at infinity: far away will do.
  float least = 1e-6 * max(abs(c.x), abs(c.y));
  if (abs(c.z) < least) c.z = c.z < 0.0 ? -least : least;
  float half_p = 0.5 * c.y / c.z, root = sqrt(max(half_p * half_p - c.x / c.z, 0.0));
  return vec2(-half_p - root, -half_p + root);
}

// Weight of point `a` in the distribution on a, p and q with moments b.
float weight_of(float a, float p, float q, vec4 b) { return (b.y - (p + q) * b.x + p * q) / ((a - p) * (a - q)); }

// Steps 4-6: the sum of the weights of what lies nearer than z. `points` from other_points.
float nearer_share(vec4 b, float z, vec2 points) {
  if (z <= points.x) return 0.0;
  if (z <= points.y) return clamp(weight_of(points.x, z, points.y, b), 0.0, 1.0);
  return clamp(1.0 - weight_of(z, points.x, points.y, b), 0.0, 1.0);
}

// Occluded share, depth unbounded (Hamburger moment problem).
float hamburger_occlusion(vec4 b, float z) { return nearer_share(b, z, other_points(b, z)); }

// Occluded share, depth known to lie in [-1, 1] (Hausdorff moment problem; Peters et al. 2017): where the three-point
// distribution leaves the interval, the extreme one has points at both its ends, at z and at a fourth place u. (1 - x^2) times
// the distribution has the points z and u alone, with moments n.
float hausdorff_occlusion(vec4 b, float z) {
  const float LAST = 0.9999;  // z at an end would coincide with that point
  z = clamp(z, -LAST, LAST);
  vec2 points = other_points(b, z);
  if (points.x >= -1.0 && points.y <= 1.0) return nearer_share(b, z, points);
  vec3 n = vec3(1.0 - b.y, b.x - b.z, b.y - b.w);
  float lever = z * n.x - n.y;
  float u = lever == 0.0 ? LAST : clamp((z * n.y - n.z) / lever, -LAST, LAST);
  float spread = max(n.z - 2.0 * z * n.y + z * z * n.x, SMALLEST_PIVOT);
  float at_u = clamp(lever * lever / spread, 0.0, max(n.x, 0.0)), at_z = max(n.x - at_u, 0.0);
  float at_near_end = 0.5 * (1.0 - b.x - at_z / (1.0 + z) - at_u / (1.0 + u));
  return clamp(at_near_end + (u < z ? at_u / (1.0 - u * u) : 0.0), 0.0, 1.0);
}

#endif
