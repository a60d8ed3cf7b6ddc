// Caps of one light's volumes: the triangles that cast, near and, with z-fail, far. Also the number of the sides' vertices.
#include "volume/shadow_volumes.glsl"

layout(local_size_x = 64) in;

void emit(uint list, uvec3 corners, uint instance) {
  uint at = arguments[list + 2] + atomicAdd(arguments[list], 3u);
  for (int i = 0; i < 3; ++i) vertices[at + i] = uvec2(corners[i], instance);
}

void main() {
  if (gl_GlobalInvocationID.x == 0u) arguments[SIDES] = side_vertices() * counts[push.light];
  bool parallel = is_directional(lights[push.light]);
  uint first = push.light * push.triangles;
  for (uint i = gl_GlobalInvocationID.x; i < push.cap_count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
    int side = facing[first + i];
    if (side == 0) continue;
    uvec4 triangle = triangles[i];
    uint instance = triangle.w & INSTANCE;
    if (push.z_fail != 0 || (triangle.w & SEE_THROUGH) != 0) emit(side > 0 ? CAPS : TURNED_CAPS, triangle.xyz, instance);
    // The far cap of parallel light is a single point.
    if (push.z_fail != 0 && !parallel) emit(FAR_CAPS, (side > 0 ? triangle.zyx : triangle.xyz) | AT_INFINITY, instance);
  }
}
