// The receiver as the shadow test sees it: the depth of its tangent plane at every texel of the map, bias included.
// Pure functions.
//
// A plane is affine in map coordinates in 1/z for a perspective view and in z for an orthographic one, so the plane's
// depth at a texel costs one multiply-add (and one reciprocal for linear depth in a perspective view).
#ifndef GNOMON_RECEIVER_PLANE
#define GNOMON_RECEIVER_PLANE

#include "light_view.glsl"

// Steepest slope that a plane is followed along, as a tangent: beyond, the plane is nearly edge-on to the light and one
// texel covers more depth than any bias could (87 degrees).
const float MAX_SLOPE = 20.0;

struct Receiver {
  vec2 texel;     // position in the map, texels
  float base;     // plane value (1/z or z) at `texel`, biased
  vec2 gradient;  // of the plane value, per texel
  float z;        // distance along the view's axis, world units
  float slope;    // tangent of the angle between the plane and the map's texels
};

// `q`: point in the view's frame; `n`: unit geometric normal there, towards the light; `size`: texels a side.
Receiver make_receiver(LightView view, vec3 q, vec3 n, float size) {
  vec3 projected = light_project(view, q);
  Receiver r;
  r.texel = projected.xy * size;
  r.z = projected.z;
  // n . x = c with x = z * ray (perspective) or ray - z e_z (orthographic), ray affine in the map coordinates.
  vec2 step = 2.0 * vec2(view.range.z, -view.range.w) / size;  // lateral units per texel
  if (is_orthographic(view)) {
    // z = (n.xy . lateral - c) / n.z
    float facing = max(n.z, 1e-4);
    r.base = r.z;
    r.gradient = n.xy * step / facing;
    r.slope = min(length(n.xy) / facing, MAX_SLOPE);
    r.gradient *= min(1.0, MAX_SLOPE * facing / max(length(n.xy), 1e-6));
  } else {
    // 1/z = n . ray / c, c = n . q = -(distance of the light from the plane), negative when the plane faces the light.
    float towards = max(-dot(n, q), 1e-6 * r.z);
    r.base = 1.0 / r.z;
    vec2 gradient = -n.xy * step / towards;
    // dz / d(lateral world unit) = z^2 d(1/z) / (z d(lateral tangent)).
    float slope = length(gradient / step) * r.z;
    r.slope = min(slope, MAX_SLOPE);
    r.gradient = gradient * min(1.0, MAX_SLOPE / max(slope, 1e-6));
  }
  return r;
}

// Moves the plane by `bias` world units towards the light, along the view's axis.
Receiver bias_receiver(LightView view, Receiver r, float bias) {
  if (is_orthographic(view))
    r.base -= bias;
  else
    r.base = 1.0 / max(r.z - bias, 1e-6 * r.z);
  return r;
}

// Encoded depth of the plane at a position of the map, in texels; at most 1, as empty texels have it: a plane that runs
// beyond the far distance between two texels is not in the shadow of nothing.
float receiver_depth(LightView view, Receiver r, vec2 at, bool linear) {
  float value = r.base + dot(r.gradient, at - r.texel);
  if (is_orthographic(view)) return min(encode_linear(view, value), 1.0);
  // A plane that passes behind the light within the offset counts as infinitely far.
  value = max(value, 1.0 / (1e4 * r.z));
  return min(linear ? encode_linear(view, 1.0 / value) : encode_perspective(view, value), 1.0);
}

// The same at four positions, given by their coordinates.
vec4 receiver_depths(LightView view, Receiver r, vec4 x, vec4 y, bool linear) {
  vec4 value = r.base + r.gradient.x * (x - r.texel.x) + r.gradient.y * (y - r.texel.y);
  if (is_orthographic(view)) return min(encode_linear(view, value), 1.0);
  value = max(value, 1.0 / (1e4 * r.z));
  return min(linear ? encode_linear(view, 1.0 / value) : encode_perspective(view, value), 1.0);
}

#endif
