#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "engine/error.h"
#include "engine/scene.h"

namespace gnomon {
namespace {

constexpr double margin = 0.01;          // of near and far, and of an orthographic map's half width
constexpr double smallest_near = 1e-6;   // of far
constexpr double smallest_depth = 1e-9;  // of the scene's radius: nothing nearer to the light counts

struct Range {  // of depths along the view axis; empty when lo > hi
  double lo = 1e300, hi = -1e300;
  bool empty() const { return lo > hi; }
  void add(double d) { lo = std::min(lo, d), hi = std::max(hi, d); }
  void add(const Range& other) { lo = std::min(lo, other.lo), hi = std::max(hi, other.hi); }
};

// A half space dot(normal, p) + offset >= 0 in light space.
struct Plane {
  glm::dvec3 normal;
  double offset = 0;
  double distance(const glm::dvec3& p) const { return glm::dot(normal, p) + offset; }
};
using Frustum = std::array<Plane, 5>;  // four sides through the light, and z <= -nearest

Frustum perspective_frustum(double half_width, double half_height, double nearest) {
  return {Plane{{1, 0, -half_width}}, Plane{{-1, 0, -half_width}}, Plane{{0, 1, -half_height}},
          Plane{{0, -1, -half_height}}, Plane{{0, 0, -1}, -nearest}};
}

// A triangle against 5 planes has at most 8 corners (Sutherland and Hodgman 1974).
struct Polygon {
  std::array<glm::dvec3, 10> corners;
  size_t count = 0;
  void add(const glm::dvec3& p) {
    if (count < corners.size()) corners[count++] = p;
  }
};

Polygon clip(const Polygon& polygon, const Plane& plane) {
  Polygon result;
  for (size_t i = 0; i < polygon.count; ++i) {
    const glm::dvec3 &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
    const double da = plane.distance(a), db = plane.distance(b);
    if (da >= 0) result.add(a);
    if ((da >= 0) != (db >= 0)) result.add(a + (b - a) * (da / (da - db)));
  }
  return result;
}

struct Transformed {  // one mesh in light space; outcodes: bit i set when outside plane i
  std::vector<glm::dvec3> positions;
  std::vector<uint8_t> outcodes;
};

uint8_t outcode(const Frustum& frustum, const glm::dvec3& p) {
  uint8_t code = 0;
  for (size_t i = 0; i < frustum.size(); ++i)
    code = static_cast<uint8_t>(code | (frustum[i].distance(p) < 0 ? 1u << i : 0u));
  return code;
}

void add_clipped(const Frustum& frustum, uint8_t crossed, const std::array<glm::dvec3, 3>& triangle,
                 Range& range) {
  Polygon polygon;
  for (const glm::dvec3& p : triangle) polygon.add(p);
  for (size_t i = 0; i < frustum.size(); ++i)
    if ((crossed >> i & 1) != 0) polygon = clip(polygon, frustum[i]);
  for (size_t i = 0; i < polygon.count; ++i) range.add(-polygon.corners[i].z);
}

// The corners of an object-space box decide first: all outside one plane, or all inside.
std::pair<uint8_t, uint8_t> box_outcodes(const Bounds& box, const glm::dmat4& light_from_object,
                                         const Frustum& frustum) {
  uint8_t all = 0xFF, any = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner((i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                            (i & 4) != 0 ? box.max.z : box.min.z);
    const uint8_t code = outcode(frustum, glm::dvec3(light_from_object * glm::dvec4(corner, 1.0)));
    all &= code, any |= code;
  }
  return {all, any};
}

// Depths of the part of a mesh inside the frustum: its triangles are clipped, so that a large one counts with
// what the frustum holds of it and with nothing else.
void add_mesh(const Mesh& mesh, const glm::dmat4& light_from_object, const Frustum& frustum,
              Transformed& work, Range& range) {
  const auto [all, any] = box_outcodes(mesh.bounds, light_from_object, frustum);
  if (all != 0) return;
  const auto to_light = [&](const glm::vec3& p) {
    return glm::dvec3(light_from_object * glm::dvec4(glm::dvec3(p), 1.0));
  };
  if (any == 0) {
    for (const glm::vec3& p : mesh.positions) range.add(-to_light(p).z);
    return;
  }
  work.positions.resize(mesh.positions.size());
  work.outcodes.resize(mesh.positions.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    work.positions[i] = to_light(mesh.positions[i]);
    work.outcodes[i] = outcode(frustum, work.positions[i]);
    if (work.outcodes[i] == 0) range.add(-work.positions[i].z);
  }
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    const uint8_t crossed = work.outcodes[a] | work.outcodes[b] | work.outcodes[c];
    if (crossed == 0 || (work.outcodes[a] & work.outcodes[b] & work.outcodes[c]) != 0) continue;
    add_clipped(frustum, crossed, {work.positions[a], work.positions[b], work.positions[c]}, range);
  }
}

double scene_size(const Scene& scene) {
  const double radius = scene.bounds.radius();
  return radius > 0 && std::isfinite(radius) ? radius : 1.0;
}

Range depths_inside(const Scene& scene, const LightFace& face) {
  const Frustum frustum =
      perspective_frustum(face.half_width, face.half_height, smallest_depth * scene_size(scene));
  Range range;
  Transformed work;
  for (const Instance& instance : scene.instances)
    add_mesh(scene.meshes[instance.mesh], face.light_from_world * instance.world_from_object, frustum, work,
             range);
  return range;
}

void set_perspective_range(LightFace& face, Range range, double size) {
  if (range.empty()) range = {0.01 * size, size};  // nothing in sight: any valid range will do
  face.far = range.hi * (1.0 + margin);
  face.near = std::max(range.lo * (1.0 - margin), face.far * smallest_near);
}

LightFace spot_face(const Scene& scene, uint32_t index) {
  const Light& light = scene.lights[index];
  LightFace face;
  face.light = index;
  face.light_from_world = glm::inverse(light.world_from_light);
  face.half_width = face.half_height = std::tan(0.5 * light.map_fov);
  set_perspective_range(face, depths_inside(scene, face), scene_size(scene));
  return face;
}

// Fitted to the vertices along the light's own axes. The position of a directional light means nothing: the
// view is moved so that the map is centred on the scene and the nearest vertex is one scene depth away.
LightFace directional_face(const Scene& scene, uint32_t index) {
  LightFace face;
  face.light = index;
  face.orthographic = true;
  glm::dmat4 axes = scene.lights[index].world_from_light;
  axes[3] = glm::dvec4(scene.bounds.centre(), 1.0);  // near the scene, so that far origins lose no digits
  const glm::dmat4 light_from_world = glm::inverse(axes);
  Bounds box;
  for (const Instance& instance : scene.instances) {
    const glm::dmat4 light_from_object = light_from_world * instance.world_from_object;
    for (const glm::vec3& p : scene.meshes[instance.mesh].positions)
      box.add(glm::dvec3(light_from_object * glm::dvec4(glm::dvec3(p), 1.0)));
  }
  if (box.empty()) box.add(glm::dvec3(0.0));
  const double size = scene_size(scene);
  const double depth = std::max(box.max.z - box.min.z, 1e-3 * size);
  const glm::dvec3 centre = box.centre();
  axes[3] = axes * glm::dvec4(centre.x, centre.y, box.max.z + depth, 1.0);
  face.light_from_world = glm::inverse(axes);
  face.half_width = std::max(0.5 * (box.max.x - box.min.x) * (1.0 + margin), 1e-3 * size);
  face.half_height = std::max(0.5 * (box.max.y - box.min.y) * (1.0 + margin), 1e-3 * size);
  face.near = (1.0 - margin) * depth;
  face.far = (1.0 + margin) * 2.0 * depth;
  return face;
}

struct Axes {
  glm::dvec3 forward, up;
};
// Layer order, and the direction that is up in each face: +y on the four sides; +z on +y and -z on -y, so
// that the upper edge of each side face meets the y faces without a turn about the z axis.
constexpr std::array<Axes, 6> cube_axes = {{{{1, 0, 0}, {0, 1, 0}},
                                            {{-1, 0, 0}, {0, 1, 0}},
                                            {{0, 1, 0}, {0, 0, 1}},
                                            {{0, -1, 0}, {0, 0, -1}},
                                            {{0, 0, 1}, {0, 1, 0}},
                                            {{0, 0, -1}, {0, 1, 0}}}};

void add_point_faces(const Scene& scene, uint32_t index, uint32_t map_size, uint32_t border,
                     std::vector<LightFace>& faces) {
  if (map_size <= 2 * static_cast<uint64_t>(border))
    fail("a border of " + std::to_string(border) + " texels leaves nothing of a map of " +
             std::to_string(map_size),
         {}, "light '" + scene.lights[index].name + "'", "use a larger shadow map");
  const double half = static_cast<double>(map_size) / (static_cast<double>(map_size) - 2.0 * border);
  Range range;
  const size_t first = faces.size();
  for (const Axes& axes : cube_axes) {
    glm::dmat4 light_from_face(1.0);
    light_from_face[0] = glm::dvec4(glm::cross(axes.forward, axes.up), 0.0);
    light_from_face[1] = glm::dvec4(axes.up, 0.0);
    light_from_face[2] = glm::dvec4(-axes.forward, 0.0);
    LightFace face;
    face.light = index;
    face.light_from_world = glm::inverse(scene.lights[index].world_from_light * light_from_face);
    face.half_width = face.half_height = half;
    range.add(depths_inside(scene, face));
    faces.push_back(face);
  }
  // One range for all, so that depths can be compared across faces.
  for (size_t i = first; i < faces.size(); ++i) set_perspective_range(faces[i], range, scene_size(scene));
}

}  // namespace

glm::dmat4 LightFace::clip_from_light() const {
  glm::dmat4 clip(0.0);
  clip[0].x = 1.0 / half_width;
  clip[1].y = -1.0 / half_height;
  if (orthographic) {
    clip[2].z = -1.0 / (far - near);
    clip[3].z = -near / (far - near);
    clip[3].w = 1.0;
  } else {
    clip[2].z = -far / (far - near);
    clip[3].z = -near * far / (far - near);
    clip[2].w = -1.0;
  }
  return clip;
}

std::vector<LightFace> light_faces(const Scene& scene, uint32_t map_size, uint32_t border) {
  std::vector<LightFace> faces;
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    switch (scene.lights[i].type) {
      case LightType::spot:
        faces.push_back(spot_face(scene, i));
        break;
      case LightType::directional:
        faces.push_back(directional_face(scene, i));
        break;
      case LightType::point:
        add_point_faces(scene, i, map_size, border, faces);
        break;
    }
  }
  return faces;
}

}  // namespace gnomon
