// Silhouette edges of one light: every edge, as often as its casting triangles do not cancel out (Kim et al. 2008). An edge
// between two triangles that cast alike is none; one of an open boundary is there once; a fold of an open mesh twice.
#include "volume/silhouettes.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
  uint light, count, triangles, capacity;  // of edges; of triangles; of silhouette edges
} push;

void main() {
  uint first_facing = push.light * push.triangles, first = push.light * push.capacity;
  for (uint i = gl_GlobalInvocationID.x; i < push.count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
    uvec4 edge = mesh_edges[i];
    int times = 0;
    for (uint k = edge.z; k < edge.z + edge.w; ++k) {
      uint incident = incidents[k];
      int side = facing[first_facing + (incident >> 1)];
      times += (incident & 1u) != 0 ? -side : side;
    }
    if (times == 0) continue;
    uint instance = triangles[incidents[edge.z] >> 1].w & INSTANCE;
    uint a = times > 0 ? edge.x : edge.y, b = times > 0 ? edge.y : edge.x;
    uint at = first + atomicAdd(counts[push.light], uint(abs(times)));
    for (int k = 0; k < abs(times); ++k) edges[at + k] = uvec4(a, b, instance, i);
  }
}
