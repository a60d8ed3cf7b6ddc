// How every triangle casts for one light: 1 as it is wound, -1 turned over, 0 not at all. Decided once a triangle, so that
// all of its edges agree.
#include "volume/silhouettes.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
  uint light, count;  // of triangles
} push;

const float ROUNDING = 5e-7;  // relative error of a position: four units in the last place

// Which side of the triangle faces the light: 1 the one that is wound counter-clockwise, -1 the other. 0: the light lies in the
// triangle's plane, as far as positions tell. Such a triangle has no shadow; but its far cap would be any plane through the light.
int side_to_light(Light light, vec3 a, vec3 b, vec3 c) {
  bool parallel = is_directional(light);
  vec3 to_light = parallel ? -light.direction.xyz : light.position.xyz - a;
  vec3 ab = b - a, ac = c - a, n = cross(ab, ac);
  float volume = dot(n, to_light);
  float moved = ROUNDING * max(max(length(a), length(b)), length(c));  // each corner, by rounding
  float error = moved * length(to_light) * (length(ab) + length(ac));
  error += length(n) * (parallel ? ROUNDING : moved + ROUNDING * length(light.position.xyz));
  return abs(volume) <= error ? 0 : volume > 0.0 ? 1 : -1;
}

void main() {
  Light light = lights[push.light];
  uint first = push.light * push.count;
  for (uint i = gl_GlobalInvocationID.x; i < push.count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
    uvec4 triangle = triangles[i];
    uint instance = triangle.w & INSTANCE;
    int side = side_to_light(light, caster_position(triangle.x, instance), caster_position(triangle.y, instance),
                             caster_position(triangle.z, instance));
    bool front = side > 0;
    bool mirrored = instances[instance].info.z != 0;
    bool casts = side != 0 && (far_sides[instance] == 0 || front == mirrored);
    facing[first + i] = !casts ? 0 : front ? 1 : -1;
  }
}
