// One view of a shadow map: projection of points and encoding of depth. Pure functions.
//
// Depth encodings, with n and f the fitted near and far distance along the view's axis and z the point's:
//   perspective  f/(f-n) - f n / (z (f-n))     Rzeczkowski 2024, eq. 3.6
//   linear       (z - n) / (f - n)             Rzeczkowski 2024, eq. 3.7; orthographic views always, eq. 3.8
#ifndef GNOMON_LIGHT_VIEW
#define GNOMON_LIGHT_VIEW

struct LightView {
  mat4 clip_from_relative;
  vec4 rows[3];  // light_from_relative, rigid; the view looks along -z
  vec4 range;    // near, far (world units), half width, half height (tangents; orthographic: world units)
  uvec4 info;    // light, 1 when orthographic; of the i-th of all views, first and number of those of light i
};

// Is a light directional that says `so` of itself? Where all are of one kind the engine says it, and the other kind's arithmetic
// is left out.
bool known_directional(bool so) {
#if defined(NO_DIRECTIONAL_LIGHTS)
  return false;
#elif defined(ALL_DIRECTIONAL_LIGHTS)
  return true;
#else
  return so;
#endif
}
bool is_orthographic(LightView view) { return known_directional(view.info.y != 0); }

// Point or (w = 0) direction in the view's frame.
vec3 light_space(LightView view, vec4 p) { return vec3(dot(view.rows[0], p), dot(view.rows[1], p), dot(view.rows[2], p)); }

// Map coordinates in [0, 1]^2 (v down) and distance along the axis of a point in the view's frame.
vec3 light_project(LightView view, vec3 q) {
  float z = -q.z;
  vec2 half_size = view.range.zw * (is_orthographic(view) ? 1.0 : z);
  return vec3(0.5 + 0.5 * q.x / half_size.x, 0.5 - 0.5 * q.y / half_size.y, z);
}

bool view_sees(vec3 projected) {
  return projected.z > 0.0 && all(greaterThanEqual(projected.xy, vec2(0.0))) && all(lessThan(projected.xy, vec2(1.0)));
}

// World size of a texel of a map of `size` texels a side, at distance z.
float texel_world_size(LightView view, float z, float size) {
  return 2.0 * max(view.range.z, view.range.w) * (is_orthographic(view) ? 1.0 : z) / size;
}

float encode_linear(LightView view, float z) { return (z - view.range.x) / (view.range.y - view.range.x); }
float encode_perspective(LightView view, float inverse_z) {
  float scale = view.range.y / (view.range.y - view.range.x);
  return scale - scale * view.range.x * inverse_z;
}
vec4 encode_linear(LightView view, vec4 z) { return (z - view.range.x) / (view.range.y - view.range.x); }
vec4 encode_perspective(LightView view, vec4 inverse_z) {
  float scale = view.range.y / (view.range.y - view.range.x);
  return scale - scale * view.range.x * inverse_z;
}
float decode_linear(LightView view, float d) { return view.range.x + d * (view.range.y - view.range.x); }
float decode_perspective(LightView view, float d) {
  float scale = view.range.y / (view.range.y - view.range.x);
  return scale * view.range.x / (scale - d);
}
float decode_depth(LightView view, float d, bool linear) {
  return linear || is_orthographic(view) ? decode_linear(view, d) : decode_perspective(view, d);
}

#endif
