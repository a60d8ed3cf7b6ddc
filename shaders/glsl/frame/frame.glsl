// Set 0: what every pass sees. Mirrors engine/render/frame_data.h. Positions are "relative": world minus the camera's eye.
#ifndef GNOMON_FRAME
#define GNOMON_FRAME

#include "lib/light_view.glsl"

layout(set = 0, binding = 0, std140) uniform Frame {
  mat4 clip_from_relative;
  mat4 view_from_relative;
  vec4 ray_corner;  // relative position at view depth 1 of the image's top left corner; w: see image_depth()
  vec4 ray_dx, ray_dy;
  vec4 viewport;    // width, height, 1/width, 1/height
  // Near plane, 1 when reversed z, far plane (0: none) beyond which nothing is drawn; w: of an orthographic camera the view
  // depth at which its device depth ends.
  vec4 depth;
  uvec4 counts;     // lights, unused, frame index
  mat4 previous_clip_from_relative;  // the previous frame's camera; positions relative to this frame's eye
} frame;

struct Light {
  vec4 rows[3];     // light_from_relative
  vec4 position;    // relative; w: LIGHT_*
  vec4 direction;   // unit, the way it shines; w: range, 0 = unlimited
  vec4 intensity;   // candela or lux, linear RGB
  vec4 cone;        // cosines of the inner and outer half angle
  vec4 size;        // half width, half height, world units; SHAPE_*; of a directional light the tangent of half its
                    // angular diameter. All 0 without a size
};
#define SHAPE_RECTANGLE 0.0
#define SHAPE_DISC 1.0
#define SHAPE_SPHERE 2.0
#define SHAPE_POLYGON 3.0
#define LIGHT_SPOT 0.0
#define LIGHT_POINT 1.0
#define LIGHT_DIRECTIONAL 2.0
#define LIGHT_WIDE_SPOT 3.0  // with a point light's views

bool has_cone(Light light) { return light.position.w == LIGHT_SPOT || light.position.w == LIGHT_WIDE_SPOT; }

bool is_directional(Light light) { return known_directional(light.position.w == LIGHT_DIRECTIONAL); }

struct Instance {
  mat4 relative_from_object;
  vec4 normal_columns[3];
  uvec4 info;       // first triangle, material, 1 when mirrored, 1 when some animation moves it
};
struct Material {
  vec4 base_color;
  vec4 alpha;       // cutoff (0: opaque), 1 when double-sided
};

// Uniform buffers: a uniform index makes a uniform load, which software devices do once for all invocations.
layout(set = 0, binding = 1, std140) uniform Lights { Light lights[LIGHT_COUNT]; };
layout(set = 0, binding = 2, std430) readonly buffer Instances { Instance instances[]; };
layout(set = 0, binding = 3, std430) readonly buffer Materials { Material materials[]; };
layout(set = 0, binding = 4, std430) readonly buffer TriangleNormals { uint triangle_normals[]; };
layout(set = 0, binding = 5, std430) readonly buffer Positions { float scene_positions[]; };
layout(set = 0, binding = 6, std430) readonly buffer Indices { uint scene_indices[]; };

bool is_background(float device_depth) { return frame.depth.y != 0.0 ? device_depth <= 0.0 : device_depth >= 1.0; }
// Relative position at view depth 1 of a place in the image, in pixels; orthographic cameras: at the eye's depth, in parts of
// image_depth().
vec3 view_ray(vec2 place) { return frame.ray_corner.xyz + place.x * frame.ray_dx.xyz + place.y * frame.ray_dy.xyz; }
// Unit vector along the camera's axis, away from the eye.
vec3 view_axis() { return -vec3(frame.view_from_relative[0].z, frame.view_from_relative[1].z, frame.view_from_relative[2].z); }

// The camera's kind is one for all shaders of a run, so that perspective ones have no branch for it.
#ifdef ORTHOGRAPHIC_CAMERA
// Depth is linear. Standard: d = (z - near) / (end - near); reversed: 1 - d.
float view_depth(float device_depth) {
  return mix(frame.depth.x, frame.depth.w, frame.depth.y != 0.0 ? 1.0 - device_depth : device_depth);
}
// What sizes in the image go with: frame.ray_dx times this is a pixel's step in the world. For a perspective camera the view
// depth; an orthographic one shows everything as large as one with 90 degrees from here would show it.
float image_depth(float device_depth) { return frame.ray_corner.w; }
vec3 relative_position(ivec2 pixel, float device_depth) {
  return frame.ray_corner.w * view_ray(vec2(pixel) + 0.5) + view_depth(device_depth) * view_axis();
}
vec3 plane_position(vec3 p, vec3 n, vec2 place) {
  vec3 start = frame.ray_corner.w * view_ray(place), axis = view_axis();
  float facing = dot(n, axis);
  return abs(facing) > 1e-6 ? start + (dot(n, p - start) / facing) * axis : p;  // 1e-6: sine of the angle between axis and plane
}
// View depth of what a projection of positions gives.
float projected_depth(vec4 clip) { return view_depth(clip.z); }
#else
// Depth of the camera's infinite projection. Reversed: d = near / z; standard: d = 1 - near / z.
float view_depth(float device_depth) {
  return frame.depth.x / (frame.depth.y != 0.0 ? device_depth : 1.0 - device_depth);
}
float image_depth(float device_depth) { return view_depth(device_depth); }
// Relative position of a pixel's centre: view ray times linear depth, so nothing cancels at far origins.
vec3 relative_position(ivec2 pixel, float device_depth) { return view_depth(device_depth) * view_ray(vec2(pixel) + 0.5); }
// Relative position of what a place in the image shows of the plane through `p` with unit normal `n`; `p` itself where the
// plane is seen edge-on.
vec3 plane_position(vec3 p, vec3 n, vec2 place) {
  vec3 ray = view_ray(place);
  float along = dot(n, ray), to_plane = dot(n, p);
  bool in_front = along * to_plane > 1e-6 * length(ray) * abs(to_plane);  // 1e-6: sine of the angle between ray and plane
  return in_front ? (to_plane / along) * ray : p;
}
float projected_depth(vec4 clip) { return clip.w; }
#endif
// The place in the image, in pixels, of a relative position in front of the camera.
vec2 image_place(vec3 p) {
  vec4 clip = frame.clip_from_relative * vec4(p, 1.0);
  return (0.5 + 0.5 * clip.xy / clip.w) * frame.viewport.xy;
}

// Where the previous frame showed a relative position that stands still: xy its place in that image, in pixels; z its
// view depth there, not above 0 behind that camera.
vec3 previous_image_place(vec3 p) {
  vec4 clip = frame.previous_clip_from_relative * vec4(p, 1.0);
  return vec3((0.5 + 0.5 * clip.xy / clip.w) * frame.viewport.xy, projected_depth(clip));
}

// Unit vector from `p` to the light, and the distance (infinite for directional lights).
vec3 to_light(Light light, vec3 p, out float distance) {
  if (is_directional(light)) {
    distance = 1.0 / 0.0;
    return -light.direction.xyz;
  }
  vec3 d = light.position.xyz - p;
  distance = length(d);
  return d / distance;
}

// Cosine of the angle to the light below which a surface is edge-on: some roundings of a rotation in floats, so that they do not
// decide whether a wall faces the sun above it.
const float EDGE_ON = 1e-6;

// Does a surface with unit geometric normal `n` at `p` face the light? Where not, it is in shadow whatever lies between.
bool faces_light(Light light, vec3 p, vec3 n) {
  if (is_directional(light)) return dot(n, -light.direction.xyz) > EDGE_ON;
  vec3 way = light.position.xyz - p;
  vec3 size = abs(way);
  return dot(n, way) > EDGE_ON * max(size.x, max(size.y, size.z));
}

// Beyond its range a light shines on nothing.
bool in_range(Light light, vec3 p) {
  float range = light.direction.w;
  vec3 d = light.position.xyz - p;
  return range == 0.0 || is_directional(light) || dot(d, d) <= range * range;
}

// The light of a layer of an image. A single one's loads are uniform wherever the layer's number comes from.
int light_of(int layer) { return LIGHT_COUNT == 1 ? 0 : layer; }

#endif
