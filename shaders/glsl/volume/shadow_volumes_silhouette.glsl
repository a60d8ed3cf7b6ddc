// Sides of one light's volumes: every edge, as often as its casting triangles do not cancel out (Kim et al. 2008). An edge
// between two triangles that cast alike has none; one of an open boundary has one; a fold of an open mesh has two.
#include "volume/shadow_volumes.glsl"

layout(local_size_x = 64) in;

// The side behind the edge a-b of a triangle that is wound a, b towards the light.
void emit_side(uint at, uint a, uint b, uint instance, bool parallel) {
  vertices[at] = uvec2(b, instance);
  vertices[at + 1] = uvec2(a, instance);
  vertices[at + 2] = uvec2(a | AT_INFINITY, instance);
  if (parallel) return;  // all vertices at infinity are one
  vertices[at + 3] = uvec2(b, instance);
  vertices[at + 4] = uvec2(a | AT_INFINITY, instance);
  vertices[at + 5] = uvec2(b | AT_INFINITY, instance);
}

void main() {
  bool parallel = is_directional(lights[push.light]);
  uint size = parallel ? 3u : 6u;
  for (uint i = gl_GlobalInvocationID.x; i < push.count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
    uvec4 edge = edges[i];
    int times = 0;
    for (uint k = edge.z; k < edge.z + edge.w; ++k) {
      uint incident = incidents[k];
      times += (incident & 1u) != 0 ? -facing[incident >> 1] : facing[incident >> 1];
    }
    if (times == 0) continue;
    uint instance = triangles[incidents[edge.z] >> 1].w & INSTANCE;
    uint a = times > 0 ? edge.x : edge.y, b = times > 0 ? edge.y : edge.x;
    uint at = arguments[SIDES + 2] + atomicAdd(arguments[SIDES], abs(times) * size);
    for (int k = 0; k < abs(times); ++k) emit_side(at + k * size, a, b, instance, parallel);
  }
}
