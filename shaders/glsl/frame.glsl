// Set 0: what every pass sees. Mirrors engine/frame_data.h. Positions are "relative": world minus the camera's eye.
#ifndef GNOMON_FRAME
#define GNOMON_FRAME

#include "lib/light_face.glsl"

layout(set = 0, binding = 0, std140) uniform Frame {
  mat4 clip_from_relative;
  mat4 view_from_relative;
  vec4 ray_corner;  // relative position at view depth 1 of the image's top left corner
  vec4 ray_dx, ray_dy;
  vec4 viewport;    // width, height, 1/width, 1/height
  vec4 depth;       // near plane, 1 when reversed z
  uvec4 counts;     // lights, faces, frame index
} frame;

struct Light {
  vec4 rows[3];     // light_from_relative
  vec4 position;    // relative; w: LIGHT_*
  vec4 direction;   // unit, the way it shines; w: range, 0 = unlimited
  vec4 intensity;   // candela or lux, linear RGB
  vec4 cone;        // cosines of the inner and outer half angle
  uvec4 faces;      // first, count
};
#define LIGHT_SPOT 0.0
#define LIGHT_POINT 1.0
#define LIGHT_DIRECTIONAL 2.0

struct Instance {
  mat4 relative_from_object;
  vec4 normal_columns[3];
  uvec4 info;       // first triangle, material, 1 when mirrored
};
struct Material {
  vec4 base_color;
  vec4 alpha;       // cutoff (0: opaque), 1 when double-sided
};

// Uniform buffers: a uniform index makes a uniform load, which software devices do once for all invocations.
layout(set = 0, binding = 1, std140) uniform Lights { Light lights[LIGHT_COUNT]; };
layout(set = 0, binding = 2, std140) uniform Faces { LightFace faces[FACE_COUNT]; };
layout(set = 0, binding = 3, std430) readonly buffer Instances { Instance instances[]; };
layout(set = 0, binding = 4, std430) readonly buffer Materials { Material materials[]; };
layout(set = 0, binding = 5, std430) readonly buffer TriangleNormals { uint triangle_normals[]; };
layout(set = 0, binding = 6, std430) readonly buffer Positions { float scene_positions[]; };
layout(set = 0, binding = 7, std430) readonly buffer Indices { uint scene_indices[]; };

// Depth of the camera's infinite projection. Reversed: d = near / z; standard: d = 1 - near / z.
bool is_background(float device_depth) { return frame.depth.y != 0.0 ? device_depth <= 0.0 : device_depth >= 1.0; }
float view_depth(float device_depth) {
  return frame.depth.x / (frame.depth.y != 0.0 ? device_depth : 1.0 - device_depth);
}
// Relative position of a pixel's centre: view ray times linear depth, so nothing cancels at far origins.
vec3 relative_position(ivec2 pixel, float device_depth) {
  vec2 centre = vec2(pixel) + 0.5;
  vec3 ray = frame.ray_corner.xyz + centre.x * frame.ray_dx.xyz + centre.y * frame.ray_dy.xyz;
  return view_depth(device_depth) * ray;
}

// Unit vector from `p` to the light, and the distance (infinite for directional lights).
vec3 to_light(Light light, vec3 p, out float distance) {
  if (light.position.w == LIGHT_DIRECTIONAL) {
    distance = 1.0 / 0.0;
    return -light.direction.xyz;
  }
  vec3 d = light.position.xyz - p;
  distance = length(d);
  return d / distance;
}

// The face of the shadow map that sees `p`: of a point light, the one of its major axis (+x -x +y -y +z -z).
uint face_of(Light light, vec3 p) {
  if (light.faces.y == 1) return light.faces.x;
  vec4 h = vec4(p, 1.0);
  vec3 q = vec3(dot(light.rows[0], h), dot(light.rows[1], h), dot(light.rows[2], h));
  vec3 a = abs(q);
  uint axis = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
  return light.faces.x + 2 * axis + (q[axis] < 0.0 ? 1 : 0);
}

#endif
