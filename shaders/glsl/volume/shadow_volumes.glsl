// What the shaders of shadow volumes share. Mirrors passes/volume/silhouette_mesh.h.
#ifndef GNOMON_SHADOW_VOLUMES
#define GNOMON_SHADOW_VOLUMES

#include "frame/frame.glsl"

layout(push_constant) uniform Push {
  uint light;
  uint z_fail;  // 1: count behind the pixel, with caps
  uint count;   // triangles or edges
} push;

const uint CLOSED = 1u << 31;       // cast from the triangles that face away from the light
const uint SEE_THROUGH = 1u << 30;  // the camera may look through its surface
const uint INSTANCE = SEE_THROUGH - 1u;
const uint AT_INFINITY = 1u << 31;  // of a vertex: moved away from the light, all the way

// What the three draws hold, as places in `arguments` of their vertex counts and first vertices.
const uint SIDES = 0u;        // sides and far caps, wound outwards
const uint CAPS = 4u;         // near caps as the mesh has them, wound towards the light
const uint TURNED_CAPS = 8u;  // and wound away from it

vec3 caster_position(uint vertex, uint instance) {
  vec3 p = vec3(scene_positions[3 * vertex], scene_positions[3 * vertex + 1], scene_positions[3 * vertex + 2]);
  return (instances[instance].relative_from_object * vec4(p, 1.0)).xyz;
}

#endif
