// Measures how far from a light the scene's vertices are.
#include "engine/light/view_depths.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace gnomon {
namespace {

constexpr double kSmallestDepth = 1e-9;  // of the scene's size: nothing nearer to the light counts
constexpr int kLowestExponent = -192, kHighestExponent = 191;  // of distances; others count with these

size_t shell_of(double distance) {
  const auto bits = static_cast<int>(std::bit_cast<uint64_t>(distance) >> 52 & 0x7FF);  // biased exponent
  return static_cast<size_t>(std::clamp(bits - 1023, kLowestExponent, kHighestExponent) - kLowestExponent);
}

struct Depths {
  Shells shells;
  double reach = std::numeric_limits<double>::infinity();
  void add(double d) {
    if (d <= reach) shells.add(d, glm::dvec3(d));
  }
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
  std::array<glm::dvec3, 10> corners{};
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
                 Depths& range) {
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
              Transformed& work, Depths& range) {
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

bool takes(Which which, const Instance& instance) {
  if (!instance.visible) return false;
  return which == Which::all || instance.moving == (which == Which::moving);
}

double largest_of(const glm::dvec3& v) {
  return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::abs(v.z));
}

}  // namespace

void Shells::add(double distance, const glm::dvec3& p) {
  if (shells_.empty()) shells_.resize(kHighestExponent - kLowestExponent + 1);
  Shell& shell = shells_[shell_of(distance)];
  shell.nearest = std::min(shell.nearest, distance), shell.farthest = std::max(shell.farthest, distance);
  shell.box.add(p);
}

void Shells::add(const Shells& other) {
  if (shells_.empty()) shells_.resize(other.shells_.size());
  for (size_t i = 0; i < other.shells_.size(); ++i) {
    const Shell& from = other.shells_[i];
    Shell& to = shells_[i];
    if (from.box.empty()) continue;
    to.nearest = std::min(to.nearest, from.nearest), to.farthest = std::max(to.farthest, from.farthest);
    to.box.add(from.box.min), to.box.add(from.box.max);
  }
}

Bounds Shells::all() const {
  Bounds box;
  for (const Shell& shell : shells_)
    if (!shell.box.empty()) box.add(shell.box.min), box.add(shell.box.max);
  return box;
}

std::vector<double> Shells::gaps(double ratio) const {
  std::vector<double> result;
  double before = -1;
  for (const Shell& shell : shells_) {
    if (shell.box.empty()) continue;
    if (before > 0 && shell.nearest >= ratio * before) result.push_back(before * std::sqrt(ratio));
    before = shell.farthest;
  }
  return result;
}

double scene_size(const Scene& scene) {
  const double radius = scene.bounds.radius();
  return radius > 0 && std::isfinite(radius) ? radius : 1.0;
}

Shells depths_inside(const Scene& scene, const LightView& view, const Measured& measured, double from) {
  const Frustum frustum =
      perspective_frustum(view.half_width, view.half_height, from + kSmallestDepth * measured.size);
  Depths depths{{}, measured.reach};
  Transformed work;
  for (const Instance& instance : scene.instances)
    if (takes(measured.which, instance))
      add_mesh(scene.meshes[instance.mesh], view.light_from_world * instance.world_from_object, frustum, work,
               depths);
  return depths.shells;
}

Shells box_along(const Scene& scene, const glm::dmat4& axes, const Measured& measured) {
  const glm::dmat4 light_from_world = glm::inverse(axes);
  const glm::dvec3 middle(light_from_world * glm::dvec4(measured.middle, 1.0));
  Shells box;
  for (const Instance& instance : scene.instances) {
    if (!takes(measured.which, instance)) continue;
    const glm::dmat4 light_from_object = light_from_world * instance.world_from_object;
    for (const glm::vec3& vertex : scene.meshes[instance.mesh].positions) {
      const glm::dvec3 p(light_from_object * glm::dvec4(glm::dvec3(vertex), 1.0));
      const double distance = largest_of(p - middle);
      if (distance <= measured.reach) box.add(distance, p);
    }
  }
  return box;
}

}  // namespace gnomon
