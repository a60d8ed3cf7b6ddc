// Vertices of shadow volumes, at the caster or at infinity behind it. NEAR_CAP: as scene.vert.glsl computes them, to meet
// the G-buffer's depth bit for bit.
#include "volume/shadow_volumes.glsl"

layout(location = 0) in uvec2 in_reference;  // vertex and instance
invariant gl_Position;

void main() {
  vec3 relative = caster_position(in_reference.x & ~AT_INFINITY, in_reference.y);
#if NEAR_CAP
  gl_Position = frame.clip_from_relative * vec4(relative, 1.0);
#else
  bool far = (in_reference.x & AT_INFINITY) != 0;
  Light light = lights[push.light];
  vec3 away = is_directional(light) ? light.direction.xyz : relative - light.position.xyz;
  gl_Position = frame.clip_from_relative * (far ? vec4(away, 0.0) : vec4(relative, 1.0));
#endif
}
