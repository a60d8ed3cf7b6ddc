// How every triangle casts for one light: 1 as it is wound, -1 turned over, 0 not at all. Decided once a triangle, so that
// all of its edges agree. Casting triangles are also the volume's caps.
#include "shadow_volumes.glsl"

layout(local_size_x = 64) in;

void emit(uint list, uvec3 corners, uint instance) {
  uint at = arguments[list + 2] + atomicAdd(arguments[list], 3u);
  for (int i = 0; i < 3; ++i) vertices[at + i] = uvec2(corners[i], instance);
}

// Does the light see the side that is wound counter-clockwise?
bool sees_front(Light light, vec3 a, vec3 b, vec3 c) {
  vec3 to_light = light.position.w == LIGHT_DIRECTIONAL ? -light.direction.xyz : light.position.xyz - a;
  return dot(cross(b - a, c - a), to_light) >= 0.0;
}

void main() {
  Light light = lights[push.light];
  for (uint i = gl_GlobalInvocationID.x; i < push.count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
    uvec4 triangle = triangles[i];
    uint instance = triangle.w & INSTANCE;
    bool front = sees_front(light, caster_position(triangle.x, instance), caster_position(triangle.y, instance),
                            caster_position(triangle.z, instance));
    bool closed = (triangle.w & CLOSED) != 0;
    bool mirrored = instances[instance].info.z != 0;
    // A watertight mesh casts from the far side: its caps then never coincide with lit receivers.
    bool casts = !closed || front == mirrored;
    facing[i] = !casts ? 0 : front ? 1 : -1;
    if (!casts) continue;
    if (push.z_fail != 0 || (triangle.w & SEE_THROUGH) != 0) emit(front ? CAPS : TURNED_CAPS, triangle.xyz, instance);
    // The far cap of parallel light is a single point.
    if (push.z_fail != 0 && light.position.w != LIGHT_DIRECTIONAL)
      emit(SIDES, (front ? triangle.zyx : triangle.xyz) | AT_INFINITY, instance);
  }
}
