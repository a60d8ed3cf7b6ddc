// G-buffer (Saito and Takahashi 1990): octahedral shading and geometric normals, albedo; depth is fixed-function.
// Inputs as scene.vert.glsl has them. PLAIN: for draws of one base colour.
#include "frame/frame.glsl"
#include "lib/octahedral.glsl"
#include "frame/pixel_state.glsl"

layout(location = 0) in vec3 in_relative;
layout(location = 1) in vec3 in_normal;
layout(location = 2) flat in vec4 in_base_color;
layout(location = 3) flat in vec4 in_normal_columns[3];
layout(location = 6) flat in uvec2 in_draw;
#ifndef PLAIN
layout(set = 2, binding = 0) uniform sampler2D base_color_texture;
layout(location = 7) in vec2 in_uv;
layout(location = 8) in vec4 in_color;
#endif
// Channels that somebody reads; each is defined as its location.
#ifdef NORMAL
layout(location = NORMAL) out vec2 out_normal;
#endif
#ifdef GEOMETRIC
layout(location = GEOMETRIC) out vec2 out_geometric;
#endif
#ifdef ALBEDO
layout(location = ALBEDO) out vec4 out_albedo;
#endif

#ifdef UNSHADOWED_LOCATION
layout(location = UNSHADOWED_LOCATION) out float out_unshadowed[LIGHT_COUNT];
#endif

// The way that the camera looks at the pixel; of any length.
vec3 view_ray() {
#ifdef ORTHOGRAPHIC_CAMERA
  return view_axis();
#else
  return in_relative;
#endif
}

// From the triangle itself, not from screen derivatives: exact at silhouettes and on slivers.
// Some software devices have no gl_PrimitiveID, so that derivatives must do; back faces of single-sided meshes are culled:
// all normals face the camera.
vec3 geometric_normal() {
#ifdef NO_PRIMITIVE_NUMBER
  vec3 across = normalize(cross(dFdxFine(in_relative), dFdyFine(in_relative)));
  return dot(across, view_ray()) > 0.0 ? -across : across;
#else
  vec3 n = octahedral_decode(unpackSnorm2x16(triangle_normals[in_draw.x + gl_PrimitiveID]));
  return normalize(in_normal_columns[0].xyz * n.x + in_normal_columns[1].xyz * n.y + in_normal_columns[2].xyz * n.z);
#endif
}

void main() {
#ifdef NO_PRIMITIVE_NUMBER
  vec3 geometric = geometric_normal();  // before anything is discarded: derivatives need whole quads
#endif
#if defined(FAR_PLANE) && defined(ORTHOGRAPHIC_CAMERA)
  if (view_depth(gl_FragCoord.z) > frame.depth.z) discard;
#elif defined(FAR_PLANE)  // the projection's is infinitely far
  if (gl_FragCoord.w * frame.depth.z < 1.0) discard;
#endif
#ifdef PLAIN
  vec4 color = in_base_color;
#else
  vec4 color = in_base_color * in_color * texture(base_color_texture, in_uv);
#endif
#ifdef MASKED
  if (color.a < in_normal_columns[0].w) discard;
#endif
#ifndef NO_PRIMITIVE_NUMBER
  vec3 geometric = geometric_normal();
#endif
  vec3 shading = normalize(in_normal);
  // Double-sided meshes are seen from either side: normals turn to the camera.
  if (in_draw.y != 0u && dot(geometric, view_ray()) > 0.0) geometric = -geometric;
  if (dot(shading, geometric) < 0.0) shading = -shading;
#ifdef NORMAL
  out_normal = octahedral_encode(shading);
#endif
#ifdef GEOMETRIC
  out_geometric = octahedral_encode(geometric);
#endif
#ifdef ALBEDO
  out_albedo = vec4(color.rgb, 1.0);
#endif
#ifdef UNSHADOWED_LOCATION
  for (int i = 0; i < LIGHT_COUNT; ++i)
    out_unshadowed[i] = unmapped_visibility(faces_light(lights[i], in_relative, geometric) ? PIXEL_OUTSIDE : PIXEL_AWAY);
#endif
}
