// How much of a light the receiver's own tangent plane leaves: what lies below its horizon is dark, whatever a map says. Pure
// functions.
//
// The light is the square [-1, 1]^2 or the disc in it; its point p is above the horizon where dot(slope, p) + height > 0.
#ifndef GNOMON_LIGHT_HORIZON
#define GNOMON_LIGHT_HORIZON

struct Horizon {
  vec2 slope;
  float height;
};

// `q`: the receiver, `n`: its normal, in the frame of a light that looks along -z from the origin. The square's axes are x and -y,
// those of the light's map. `half_size`: of the light, world units.
Horizon horizon_of(vec3 q, vec3 n, vec2 half_size) { return Horizon(vec2(n.x, -n.y) * half_size, -dot(n, q)); }
// Of a directional light. `half_size`: tangents of half its angular diameters.
Horizon directional_horizon(vec3 n, vec2 half_size) { return Horizon(vec2(n.x, -n.y) * half_size, n.z); }

bool above(Horizon h, vec2 p) { return dot(h.slope, p) + h.height > 0.0; }

// Share of the square: over the lines along the smaller slope, each with a share that is linear between 0 and 1, the mean.
float square_above(Horizon h) {
  vec2 a = abs(h.slope);
  float steep = max(a.x, a.y), even = min(a.x, a.y);
  if (abs(h.height) >= steep + even) return h.height > 0.0 ? 1.0 : 0.0;
  // In units of the steep slope: lines from `low` to `high`, whose share is the line's place between -1 and 1.
  float middle = h.height / steep, reach = max(even / steep, 1e-4);
  float low = middle - reach, high = middle + reach;
  float from = clamp(low, -1.0, 1.0), to = clamp(high, -1.0, 1.0);
  float partly = (to - from) * (0.5 + 0.25 * (from + to)), wholly = max(high - max(low, 1.0), 0.0);
  return clamp((partly + wholly) / (high - low), 0.0, 1.0);
}

// Share of the disc: a segment.
float disc_above(Horizon h) {
  const float HALF_TURN = 3.14159265;  // radians
  float d = h.height / max(length(h.slope), 1e-30);
  if (abs(d) >= 1.0) return d > 0.0 ? 1.0 : 0.0;
  return 1.0 - (acos(d) - d * sqrt(1.0 - d * d)) / HALF_TURN;
}

#endif
