// Casters projected from the light onto a plane (Blinn 1988; Rzeczkowski 2024, eq. 3.1-3.3). For the plane n.x + d = 0 and the
// light l = (l.xyz, l.w), l.w = 0 at infinity, the projection is M = (n.l + d l.w) I - l (n, d)^T; here divided by the
// light's height n.l + d l.w, which is positive.
#include "volume/planar_shadows.glsl"

layout(location = 0) in vec3 in_position;
#ifdef MASKED
layout(location = 2) in vec2 in_uv;
layout(location = 3) in vec4 in_color;
layout(location = 0) out vec2 out_uv;
layout(location = 1) out float out_alpha;
#endif

const float LEAST_W = 1e-6;  // towards the light's own height the projection goes to infinity

out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[2];
};

void main() {
  vec4 p = vec4((instances[push.instance].relative_from_object * vec4(in_position, 1.0)).xyz, 1.0);
  vec4 light = light_point(lights[push.light]);
  float height = dot(push.plane, p), light_height = dot(push.plane, light);
  vec4 projected = p - light * (height / light_height);
  gl_Position = frame.clip_from_relative * projected;
  // No anti-shadow: only what lies between the plane and the light casts. The plane's own triangles lie on it.
  gl_ClipDistance[0] = height - push.tolerance;
  gl_ClipDistance[1] = projected.w - LEAST_W;
#ifdef MASKED
  out_uv = in_uv;
  out_alpha = in_color.a;
#endif
}
