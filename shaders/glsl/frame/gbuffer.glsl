// G-buffer (Saito and Takahashi 1990): octahedral shading and geometric normals, albedo; depth is fixed-function.
#include "frame/frame.glsl"
#include "lib/octahedral.glsl"
#include "frame/pixel_state.glsl"

layout(push_constant) uniform Push { uint instance, material; } push;
layout(set = 2, binding = 0) uniform sampler2D base_color_texture;
layout(location = 0) in vec3 in_relative;
layout(location = 1) in vec2 in_uv;
layout(location = 2) in vec3 in_normal;
layout(location = 3) in vec4 in_color;
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

// From the triangle itself, not from screen derivatives: exact at silhouettes and on slivers.
vec3 geometric_normal(Instance instance) {
  vec3 n = octahedral_decode(unpackSnorm2x16(triangle_normals[instance.info.x + gl_PrimitiveID]));
  vec3 turned = instance.normal_columns[0].xyz * n.x + instance.normal_columns[1].xyz * n.y + instance.normal_columns[2].xyz * n.z;
  return normalize(instance.info.z != 0 ? -turned : turned);
}

void main() {
#ifdef FAR_PLANE  // the projection's is infinitely far
  if (gl_FragCoord.w * frame.depth.z < 1.0) discard;
#endif
  Instance instance = instances[push.instance];
  Material material = materials[push.material];
  vec4 color = material.base_color * in_color * texture(base_color_texture, in_uv);
#ifdef MASKED
  if (color.a < material.alpha.x) discard;
#endif
  vec3 geometric = geometric_normal(instance);
  vec3 shading = normalize(instance.info.z != 0 ? -in_normal : in_normal);
  // Double-sided meshes are seen from either side: normals turn to the camera.
  if (material.alpha.y != 0.0 && dot(geometric, in_relative) > 0.0) geometric = -geometric;
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
