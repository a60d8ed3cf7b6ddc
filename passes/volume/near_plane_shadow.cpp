// Decides between z-fail and z-pass: may the camera's near plane lie in shadow?
#include "passes/volume/near_plane_shadow.h"
#include "engine/scene/scene.h"

#include <cmath>

namespace gnomon {
namespace {

using Points = std::vector<glm::dvec3>;

// Hull of the light and the near pyramid, as points.
Points shadow_hull(const std::vector<Bounds>& casters, const Camera& camera, double aspect,
                   const Light& light) {
  Points points = near_pyramid(camera, aspect);
  if (light.type != LightType::directional) {
    points.push_back(glm::dvec3(light.world_from_light[3]));
    return points;
  }
  Bounds all;
  for (const Bounds& b : casters) all.add(b.min), all.add(b.max);
  const double reach = glm::length(points[0] - all.centre()) + 2.0 * all.radius() + camera.near;
  const glm::dvec3 to_light = glm::normalize(glm::dvec3(light.world_from_light[2]));
  for (size_t i = 0, n = points.size(); i < n; ++i) points.push_back(points[i] + 2.0 * reach * to_light);
  return points;
}

bool separated(const Points& hull, const Bounds& box, const glm::dvec3& axis) {
  const glm::dvec3 half = 0.5 * (box.max - box.min);
  const double reach = glm::dot(half, glm::abs(axis)), middle = glm::dot(box.centre(), axis);
  double low = 1e300, high = -1e300;
  for (const glm::dvec3& p : hull) {
    const double d = glm::dot(p, axis) - middle;
    low = std::min(low, d), high = std::max(high, d);
  }
  return low > reach || high < -reach;
}

// Separating axes: the box's, and normals of planes through three of the hull's points (its faces are among
// them). Without the edge-edge axes the test is conservative.
Points separating_axes(const Points& hull) {
  Points axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (size_t i = 0; i < hull.size(); ++i)
    for (size_t k = i + 1; k < hull.size(); ++k)
      for (size_t m = k + 1; m < hull.size(); ++m) {
        const glm::dvec3 n = glm::cross(hull[k] - hull[i], hull[m] - hull[i]);
        if (glm::dot(n, n) > 0.0) axes.push_back(n);
      }
  return axes;
}

}  // namespace

std::vector<glm::dvec3> near_pyramid(const Camera& camera, double aspect) {
  constexpr double kMargin = 1.01;
  const double reach = camera.span ? 1.0 : camera.near;
  const double y = kMargin * reach * half_extent(camera, aspect).y, x = y * aspect;
  const double z = -kMargin * camera.near;
  std::vector<glm::dvec3> points;
  if (camera.span) {  // rays start all over the near plane
    for (const glm::dvec3 p : {glm::dvec3(0.0, 0.0, z), {-x, -y, z}, {x, -y, z}, {-x, y, z}, {x, y, z}})
      points.push_back(glm::dvec3(camera.world_from_camera * glm::dvec4(p, 1.0)));
    return points;
  }
  for (const glm::dvec3 p : {glm::dvec3(0.0), {-x, -y, z}, {x, -y, z}, {-x, y, z}, {x, y, z}})
    points.push_back(glm::dvec3(camera.world_from_camera * glm::dvec4(p, 1.0)));
  return points;
}

std::vector<Bounds> instance_bounds(const Scene& scene) {
  std::vector<Bounds> result;
  for (const Instance& instance : scene.instances) {
    Bounds bounds;
    for (const glm::vec3& p : scene.meshes[instance.mesh].positions)
      bounds.add(glm::dvec3(instance.world_from_object * glm::dvec4(p, 1.0)));
    result.push_back(bounds);
  }
  return result;
}

bool near_plane_may_be_shadowed(const std::vector<Bounds>& casters, const Camera& camera, double aspect,
                                const Light& light) {
  const Points hull = shadow_hull(casters, camera, aspect, light);
  const Points axes = separating_axes(hull);
  for (const Bounds& box : casters) {
    if (box.empty()) continue;
    bool apart = false;
    for (size_t i = 0; i < axes.size() && !apart; ++i) apart = separated(hull, box, axes[i]);
    if (!apart) return true;
  }
  return false;
}

}  // namespace gnomon
