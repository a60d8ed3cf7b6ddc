// Vertices of the scene for the camera. Shared by every pass that must meet the G-buffer's depth bit for bit.
#include "frame/frame.glsl"

layout(push_constant) uniform Push { uint instance; } push;
layout(location = 0) in vec3 in_position;
layout(location = 1) in vec2 in_normal;
layout(location = 2) in vec2 in_uv;
layout(location = 3) in vec4 in_color;
layout(location = 0) out vec3 out_relative;
layout(location = 1) out vec2 out_uv;
layout(location = 2) out vec3 out_normal;
layout(location = 3) out vec4 out_color;
invariant gl_Position;

#include "lib/octahedral.glsl"

void main() {
  vec4 relative = instances[push.instance].relative_from_object * vec4(in_position, 1.0);
  gl_Position = frame.clip_from_relative * vec4(relative.xyz, 1.0);
  out_relative = relative.xyz;
  out_uv = in_uv;
  vec3 n = octahedral_decode(in_normal);
  vec4 columns[3] = instances[push.instance].normal_columns;
  out_normal = columns[0].xyz * n.x + columns[1].xyz * n.y + columns[2].xyz * n.z;
  out_color = in_color;
}
