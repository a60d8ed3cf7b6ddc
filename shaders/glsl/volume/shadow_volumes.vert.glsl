// Vertices of shadow volumes, at the caster or at infinity behind it. SIDES_OF_EDGES: made of the silhouette's edges. NEAR_CAP: as
// scene.vert.glsl computes them, to meet the G-buffer's depth bit for bit.
#include "volume/shadow_volumes.glsl"

#if !SIDES_OF_EDGES
layout(location = 0) in uvec2 in_reference;  // vertex and instance
#endif
invariant gl_Position;

// A vertex of the side behind the edge a-b of a triangle that is wound a, b towards the light: b, a, a at infinity; b, a at
// infinity, b at infinity.
uvec2 side_vertex(uint i) {
  uint n = side_vertices(), corner = i % n;
  uvec4 edge = edges[push.first_edge + i / n];
  bool of_b = corner == 0u || corner == 3u || corner == 5u, far = corner == 2u || corner >= 4u;
  return uvec2((of_b ? edge.y : edge.x) | (far ? AT_INFINITY : 0u), edge.z);
}

void main() {
#if SIDES_OF_EDGES
  uvec2 reference = side_vertex(gl_VertexIndex);
#else
  uvec2 reference = in_reference;
#endif
  vec3 relative = caster_position(reference.x & ~AT_INFINITY, reference.y);
#if NEAR_CAP
  gl_Position = frame.clip_from_relative * vec4(relative, 1.0);
#else
  bool far = (reference.x & AT_INFINITY) != 0;
  Light light = lights[push.light];
  vec3 away = is_directional(light) ? light.direction.xyz : relative - light.position.xyz;
#ifdef ORTHOGRAPHIC_CAMERA
  // At infinity the camera would see nothing of a volume along its axis; so far away it sees where it ends, behind everything.
  const float NEARLY_INFINITE = 1e-12;  // 1 / distance, world units
  vec4 end = vec4(normalize(away), NEARLY_INFINITE);
#else
  vec4 end = vec4(away, 0.0);
#endif
  gl_Position = frame.clip_from_relative * (far ? end : vec4(relative, 1.0));
#endif
}
