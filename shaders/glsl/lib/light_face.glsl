// One face of a shadow map: projection of points and encoding of depth. Pure functions.
//
// Depth encodings, with n and f the fitted near and far distance along the face's axis and z the point's:
//   perspective  f/(f-n) - f n / (z (f-n))     Rzeczkowski 2024, eq. 3.6
//   linear       (z - n) / (f - n)             Rzeczkowski 2024, eq. 3.7; orthographic faces always, eq. 3.8
#ifndef GNOMON_LIGHT_FACE
#define GNOMON_LIGHT_FACE

struct LightFace {
  mat4 clip_from_relative;
  vec4 rows[3];  // light_from_relative, rigid; the face looks along -z
  vec4 range;    // near, far (world units), half width, half height (tangents; orthographic: world units)
  uvec4 info;    // light, 1 when orthographic
};

// Is a light directional that says `so` of itself? Where all are of one kind the engine says it, and the other kind's arithmetic
// is left out.
bool told_directional(bool so) {
#if defined(NO_DIRECTIONAL_LIGHTS)
  return false;
#elif defined(ALL_DIRECTIONAL_LIGHTS)
  return true;
#else
  return so;
#endif
}
bool is_orthographic(LightFace face) { return told_directional(face.info.y != 0); }

// Point or (w = 0) direction in the face's frame.
vec3 face_space(LightFace face, vec4 p) { return vec3(dot(face.rows[0], p), dot(face.rows[1], p), dot(face.rows[2], p)); }

// Map coordinates in [0, 1]^2 (v down) and distance along the axis of a point in the face's frame.
vec3 face_project(LightFace face, vec3 q) {
  float z = -q.z;
  vec2 half_size = face.range.zw * (is_orthographic(face) ? 1.0 : z);
  return vec3(0.5 + 0.5 * q.x / half_size.x, 0.5 - 0.5 * q.y / half_size.y, z);
}

bool face_sees(vec3 projected) {
  return projected.z > 0.0 && all(greaterThanEqual(projected.xy, vec2(0.0))) && all(lessThan(projected.xy, vec2(1.0)));
}

// World size of a texel of a map of `size` texels a side, at distance z.
float texel_world_size(LightFace face, float z, float size) {
  return 2.0 * max(face.range.z, face.range.w) * (is_orthographic(face) ? 1.0 : z) / size;
}

float encode_linear(LightFace face, float z) { return (z - face.range.x) / (face.range.y - face.range.x); }
float encode_perspective(LightFace face, float inverse_z) {
  float scale = face.range.y / (face.range.y - face.range.x);
  return scale - scale * face.range.x * inverse_z;
}
vec4 encode_linear(LightFace face, vec4 z) { return (z - face.range.x) / (face.range.y - face.range.x); }
vec4 encode_perspective(LightFace face, vec4 inverse_z) {
  float scale = face.range.y / (face.range.y - face.range.x);
  return scale - scale * face.range.x * inverse_z;
}
float decode_linear(LightFace face, float d) { return face.range.x + d * (face.range.y - face.range.x); }
float decode_perspective(LightFace face, float d) {
  float scale = face.range.y / (face.range.y - face.range.x);
  return scale * face.range.x / (scale - d);
}

#endif
