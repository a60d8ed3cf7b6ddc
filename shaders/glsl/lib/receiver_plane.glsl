// The receiver as the shadow test sees it: the depth of its tangent plane at every texel of the map, bias included.
// Pure functions.
//
// A plane is affine in a map's coordinates in post-projective depth, whatever the projection: so the plane's depth at a texel
// costs one multiply-add, for spot, directional and point lights, cascades and warps alike. It is kept as depth - 1, counted from
// the far distance, where floating point is finest: the perspective depth (3.6) of z is 1 + n (z - f) / ((f - n) z), (3.8) is
// 1 + (z - f) / (f - n).
//
// Whoever includes this defines MAX_SLOPE, the steepest slope that a plane is followed along, as a tangent (float).
#ifndef GNOMON_RECEIVER_PLANE
#define GNOMON_RECEIVER_PLANE

#include "light_view.glsl"

struct Receiver {
  vec2 texel;     // position in the map, texels
  float base;     // post-projective depth - 1 at `texel`, biased
  vec2 gradient;  // of it, per texel
  float z;        // distance along the view's axis, world units
  float slope;    // tangent of the angle between the plane and the map's texels
};

// Post-projective depth - 1 at distance z, and z of it.
float far_depth(LightView view, float z) {
  float n = view.range.x, f = view.range.y;
  return (is_orthographic(view) ? z - f : n * (z - f) / z) / (f - n);
}
float far_distance(LightView view, float depth) {
  float n = view.range.x, f = view.range.y;
  return is_orthographic(view) ? f + depth * (f - n) : n * f / (n - depth * (f - n));
}
// Its derivative by z.
float depth_rate(LightView view, float z) {
  float n = view.range.x, f = view.range.y;
  return (is_orthographic(view) ? 1.0 : n * f / (z * z)) / (f - n);
}

// `q`: point in the view's frame; `n`: unit geometric normal there, towards the light; `size`: texels a side.
Receiver make_receiver(LightView view, vec3 q, vec3 n, float size) {
  vec3 projected = light_project(view, q);
  Receiver r;
  r.texel = projected.xy * size;
  r.z = projected.z;
  r.base = far_depth(view, r.z);
  // The plane meets the ray through a texel further away by the normal's lateral part over the ray's along the normal.
  float facing = max(is_orthographic(view) ? n.z : -dot(n, q) / r.z, 1e-6);
  float slope = length(n.xy) / facing;
  r.slope = min(slope, MAX_SLOPE);
  vec2 step = 2.0 * vec2(view.range.z, -view.range.w) / size * (is_orthographic(view) ? 1.0 : r.z);  // a texel, world units
  r.gradient = depth_rate(view, r.z) * step * n.xy / facing * min(1.0, MAX_SLOPE / max(slope, 1e-6));
  return r;
}

// Moves the plane by `bias` world units towards the light, along the view's axis.
Receiver bias_receiver(LightView view, Receiver r, float bias) {
  r.base = far_depth(view, max(r.z - bias, 1e-6 * r.z));
  return r;
}

// Encoded depth of the plane at a position of the map, in texels; at most 1, as empty texels have it: a plane that runs
// beyond the far distance between two texels is not in the shadow of nothing. One that passes behind the light counts as
// infinitely far.
float receiver_depth(LightView view, Receiver r, vec2 at, bool linear) {
  float value = min(r.base + dot(r.gradient, at - r.texel), 0.0);
  if (!linear || is_orthographic(view)) return 1.0 + value;
  return min(encode_linear(view, far_distance(view, value)), 1.0);
}

// The same at four positions, given by their coordinates.
vec4 receiver_depths(LightView view, Receiver r, vec4 x, vec4 y, bool linear) {
  vec4 value = min(r.base + r.gradient.x * (x - r.texel.x) + r.gradient.y * (y - r.texel.y), 0.0);
  if (!linear || is_orthographic(view)) return 1.0 + value;
  float n = view.range.x, f = view.range.y;
  return min(encode_linear(view, n * f / (n - value * (f - n))), 1.0);
}

#endif
