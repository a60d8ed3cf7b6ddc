// What the shaders of shadow volumes share.
#ifndef GNOMON_SHADOW_VOLUMES
#define GNOMON_SHADOW_VOLUMES

#include "volume/silhouettes.glsl"

layout(push_constant) uniform Push {
  uint light;
  uint z_fail;      // 1: count behind the pixel, with caps
  uint triangles;   // all
  uint cap_count;   // triangles that may have caps: all, or none
  uint first_edge;  // of the light's silhouette
} push;

const uint AT_INFINITY = 1u << 31;  // of a vertex: moved away from the light, all the way

// The draws: what they hold, as places in `arguments` of their vertex counts and first vertices.
const uint SIDES = 0u;         // of silhouette edges, wound outwards; no vertices of their own
const uint FAR_CAPS = 4u;      // wound outwards
const uint CAPS = 8u;          // near caps as the mesh has them, wound towards the light
const uint TURNED_CAPS = 12u;  // and wound away from it

// Vertices of a side: two triangles, or with parallel light, whose vertices at infinity are one, one triangle.
uint side_vertices() { return is_directional(lights[push.light]) ? 3u : 6u; }

#endif
