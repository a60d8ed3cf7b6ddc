// What the shaders of casters' edges share. Mirrors passes/volume/silhouette_mesh.h.
#ifndef GNOMON_SILHOUETTES
#define GNOMON_SILHOUETTES

#include "frame/frame.glsl"

const uint SEE_THROUGH = 1u << 31;  // of a triangle: the camera may look through its surface
const uint INSTANCE = SEE_THROUGH - 1u;

vec3 caster_position(uint vertex, uint instance) {
  vec3 p = vec3(scene_positions[3 * vertex], scene_positions[3 * vertex + 1], scene_positions[3 * vertex + 2]);
  return (instances[instance].relative_from_object * vec4(p, 1.0)).xyz;
}

#endif
