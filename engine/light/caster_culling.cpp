// Finds the casters that can throw a shadow on what the camera sees, by bounds.
#include "engine/light/caster_culling.h"
#include "engine/light/light_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace gnomon {
namespace {

using Corners = std::array<glm::dvec3, 8>;

// Corners of each side of a frustum, as indices into ViewVolume's.
constexpr std::array<std::array<int, 4>, 6> kSides = {
    {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
struct Edge {
  int a, b;
  int sides[2];  // of kSides, that meet there
};
constexpr std::array<Edge, 12> kEdges = {{{0, 1, {0, 2}},
                                          {1, 2, {0, 3}},
                                          {2, 3, {0, 4}},
                                          {3, 0, {0, 5}},
                                          {4, 5, {1, 2}},
                                          {5, 6, {1, 3}},
                                          {6, 7, {1, 4}},
                                          {7, 4, {1, 5}},
                                          {0, 4, {2, 5}},
                                          {1, 5, {2, 3}},
                                          {2, 6, {3, 4}},
                                          {3, 7, {4, 5}}}};

double height(const glm::dvec4& plane, const glm::dvec3& p) {
  return glm::dot(glm::dvec3(plane), p) + plane.w;
}

// Through `on` with this normal, all corners of a convex body inside; none when the normal has no length.
std::optional<glm::dvec4> plane_around(const std::vector<glm::dvec3>& corners, const glm::dvec3& on,
                                       const glm::dvec3& normal) {
  const double length = glm::length(normal);
  if (!(length > 0)) return std::nullopt;
  glm::dvec4 plane(normal / length, -glm::dot(normal, on) / length);
  double lowest = 0, highest = 0;
  for (const glm::dvec3& p : corners)
    lowest = std::min(lowest, height(plane, p)), highest = std::max(highest, height(plane, p));
  return highest + lowest >= 0 ? plane : -plane;
}

// A side of the frustum; its far corners span it where the near ones meet in a point.
std::optional<glm::dvec4> side_plane(const std::vector<glm::dvec3>& corners, const std::array<int, 4>& side) {
  const auto corner = [&](int i) { return corners[static_cast<size_t>(side[static_cast<size_t>(i)])]; };
  return plane_around(corners, corner(2), glm::cross(corner(3) - corner(1), corner(2) - corner(0)));
}

bool inside_view(const LightView& view, const Corners& corners, const glm::dvec3& origin) {
  glm::dmat4 from = view.light_from_world;
  from[3] = from * glm::dvec4(origin, 1.0);
  if (!view.orthographic) return !outside_pyramid(corners, from, view.half_width, view.half_height, 0.0);
  Bounds box;
  for (const glm::dvec3& p : corners) box.add(glm::dvec3(from * glm::dvec4(p, 1.0)));
  return box.max.x >= -view.half_width && box.min.x <= view.half_width && box.max.y >= -view.half_height &&
         box.min.y <= view.half_height;
}

// World units that `reach` texels of a view along both axes span at most.
double reach_world(const LightView& view, uint32_t map_size, uint32_t reach) {
  const double half = std::max(view.half_width, view.half_height) * (view.orthographic ? 1.0 : view.farthest);
  return reach * std::numbers::sqrt2 * 2.0 * half / map_size;
}

}  // namespace

std::array<glm::dvec3, 8> box_corners(const Scene& scene, const Instance& instance,
                                      const glm::dvec3& origin) {
  const Bounds& box = scene.meshes[instance.mesh].bounds;
  glm::dmat4 placed = instance.world_from_object;
  placed[3] -= glm::dvec4(origin, 0.0);
  std::array<glm::dvec3, 8> corners{};
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner((i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                            (i & 4) != 0 ? box.max.z : box.min.z);
    corners[static_cast<size_t>(i)] = glm::dvec3(placed * glm::dvec4(corner, 1.0));
  }
  return corners;
}

bool outside_view(const Corners& corners, const glm::dmat4& view_from_corners, const Camera& camera,
                  double aspect) {
  const glm::dvec2 half = half_extent(camera, aspect);
  if (!camera.span) return outside_pyramid(corners, view_from_corners, half.x, half.y, camera.near);
  Bounds box;
  for (const glm::dvec3& p : corners) box.add(glm::dvec3(view_from_corners * glm::dvec4(p, 1.0)));
  return box.max.x < -half.x || box.min.x > half.x || box.max.y < -half.y || box.min.y > half.y ||
         -box.min.z < camera.near;
}

glm::dvec3 view_corner(const Camera& camera, const glm::dvec2& half, double sx, double sy, double depth) {
  const double widening = camera.span ? 1.0 : depth;
  return {sx * half.x * widening, sy * half.y * widening, -depth};
}

bool outside_pyramid(const Corners& corners, const glm::dmat4& view_from_corners, double half_width,
                     double half_height, double nearest) {
  std::array<int, 5> outside{};
  for (const glm::dvec3& p : corners) {
    const glm::dvec3 v(view_from_corners * glm::dvec4(p, 1.0));
    outside[0] += v.x < half_width * v.z;
    outside[1] += -v.x < half_width * v.z;
    outside[2] += v.y < half_height * v.z;
    outside[3] += -v.y < half_height * v.z;
    outside[4] += -v.z < nearest;
  }
  return std::find(outside.begin(), outside.end(), 8) != outside.end();
}

glm::dvec4 light_place(const Light& light, const glm::dvec3& origin) {
  if (light.type == LightType::directional) return glm::dvec4(glm::dvec3(light.world_from_light[2]), 0.0);
  return light.world_from_light[3] - glm::dvec4(origin, 0.0);
}

ViewVolume::ViewVolume(const Scene& scene, const Camera& camera, double aspect, const glm::dvec3& origin) {
  glm::dmat4 placed = camera.world_from_camera;
  placed[3] -= glm::dvec4(origin, 0.0);
  const glm::dmat4 view = glm::inverse(placed);
  const glm::dvec2 half = half_extent(camera, aspect);
  double nearest = 1e300, farthest = 0;
  for (const Instance& instance : scene.instances) {
    const Corners corners = box_corners(scene, instance, origin);
    if (outside_view(corners, view, camera, aspect)) continue;
    for (const glm::dvec3& p : corners) {
      const double depth = -glm::dvec3(view * glm::dvec4(p, 1.0)).z;
      nearest = std::min(nearest, depth), farthest = std::max(farthest, depth);
    }
  }
  if (nearest > farthest) return;
  nearest_ = std::max(nearest, camera.near);
  farthest_ = std::max(farthest, nearest_);
  for (const double z : {nearest_, farthest_})
    for (const auto& [sx, sy] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      corners_.emplace_back(placed * glm::dvec4(view_corner(camera, half, sx, sy, z), 1.0));
}

LightVolume::LightVolume(const ViewVolume& view, const glm::dvec4& light, double around)
    : around_(around), empty_(view.empty()) {
  if (empty_) return;
  const std::vector<glm::dvec3>& corners = view.corners_;
  std::array<bool, kSides.size()> kept{};
  for (size_t i = 0; i < kSides.size(); ++i) {
    const std::optional<glm::dvec4> plane = side_plane(corners, kSides[i]);
    kept[i] = plane && glm::dot(*plane, light) >= 0;  // of a direction: going there never leaves
    if (kept[i]) planes_.push_back(*plane);
  }
  // The hull's other sides go through the light and the edges that it sees as the frustum's silhouette.
  for (const Edge& edge : kEdges) {
    if (kept[static_cast<size_t>(edge.sides[0])] == kept[static_cast<size_t>(edge.sides[1])]) continue;
    const glm::dvec3 a = corners[static_cast<size_t>(edge.a)], b = corners[static_cast<size_t>(edge.b)];
    const glm::dvec3 to_light = glm::dvec3(light) - light.w * a;
    if (const auto plane = plane_around(corners, a, glm::cross(b - a, to_light))) planes_.push_back(*plane);
  }
}

bool LightVolume::meets(const std::array<glm::dvec3, 8>& corners) const {
  if (empty_) return false;
  return std::all_of(planes_.begin(), planes_.end(), [&](const glm::dvec4& plane) {
    return std::any_of(corners.begin(), corners.end(),
                       [&](const glm::dvec3& p) { return height(plane, p) >= -around_; });
  });
}

std::vector<std::vector<bool>> casters_in_view(const Scene& scene, const Camera& camera, double aspect,
                                               const std::vector<LightView>& views, uint32_t map_size,
                                               std::optional<uint32_t> reach,
                                               const std::vector<std::string>& shadowless) {
  const glm::dvec3 origin = scene.bounds.empty() ? glm::dvec3(0.0) : scene.bounds.centre();
  const ViewVolume seen(scene, camera, aspect, origin);
  std::vector<Corners> boxes;
  for (const Instance& instance : scene.instances) boxes.push_back(box_corners(scene, instance, origin));
  // Bounds are of floats, and positions on the device too: what is nearer to a plane than this is inside.
  const double rounding = 1e-5 * scene.bounds.radius();
  std::vector<std::vector<bool>> needed;
  for (const LightView& view : views) {
    std::vector<bool>& one = needed.emplace_back(boxes.size(), false);
    if (!shadowless[view.light].empty()) continue;
    const double around = rounding + (reach ? reach_world(view, map_size, *reach) : 0.0);
    const LightVolume volume(seen, light_place(scene.lights[view.light], origin), around);
    for (size_t i = 0; i < boxes.size(); ++i)
      one[i] = inside_view(view, boxes[i], origin) && (!reach || volume.meets(boxes[i]));
  }
  return needed;
}

}  // namespace gnomon
