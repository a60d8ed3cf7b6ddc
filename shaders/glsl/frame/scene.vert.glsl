// Vertices of the scene for the camera. Shared by every pass that must meet the G-buffer's depth bit for bit. What is the same
// for a whole draw comes as flat inputs, which software devices read once for a triangle, and storage buffers once for every
// pixel. PLAIN: for draws of one base colour.
#include "frame/frame.glsl"
#include "lib/octahedral.glsl"

layout(push_constant) uniform Push { uint instance, material; } push;
layout(location = 0) in vec3 in_position;
layout(location = 1) in vec2 in_normal;
layout(location = 0) out vec3 out_relative;
layout(location = 1) out vec3 out_normal;
layout(location = 2) flat out vec4 out_base_color;
layout(location = 3) flat out vec4 out_normal_columns[3];  // against a mirrored instance's winding; w of the first: alpha cutoff
layout(location = 6) flat out uvec2 out_draw;              // first triangle, 1 when double-sided
#ifndef PLAIN
layout(location = 2) in vec2 in_uv;
layout(location = 3) in vec4 in_color;
layout(location = 7) out vec2 out_uv;
layout(location = 8) out vec4 out_color;
#endif
invariant gl_Position;

void main() {
  vec4 relative = instances[push.instance].relative_from_object * vec4(in_position, 1.0);
  gl_Position = frame.clip_from_relative * vec4(relative.xyz, 1.0);
  out_relative = relative.xyz;
  uvec4 info = instances[push.instance].info;
  vec4 columns[3] = instances[push.instance].normal_columns;
  for (int i = 0; i < 3; ++i) columns[i] = info.z != 0u ? -columns[i] : columns[i];
  vec3 n = octahedral_decode(in_normal);
  out_normal = columns[0].xyz * n.x + columns[1].xyz * n.y + columns[2].xyz * n.z;
  Material material = materials[push.material];
  out_base_color = material.base_color;
  out_normal_columns[0] = vec4(columns[0].xyz, material.alpha.x);
  out_normal_columns[1] = columns[1];
  out_normal_columns[2] = columns[2];
  out_draw = uvec2(info.x, material.alpha.y != 0.0 ? 1u : 0u);
#ifndef PLAIN
  out_uv = in_uv;
  out_color = in_color;
#endif
}
