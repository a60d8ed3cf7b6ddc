// Refuses scenes that reach further than floats can be calculated with.
#include "engine/scene/scene_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"

namespace gnomon {
namespace {

bool within(const glm::dvec3& p) {
  return std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate &&
         std::abs(p.z) <= kLargestCoordinate;
}

bool within(const Instance& instance, const Bounds& bounds) {
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                       corner & 4 ? bounds.max.z : bounds.min.z);
    if (!within(glm::dvec3(instance.world_from_object * glm::dvec4(p, 1.0)))) return false;
  }
  return true;
}

}  // namespace

void check_limits(const Scene& scene) {
  Problems problems;
  const auto refuse = [&](const std::string& kind, const std::string& name, const std::string& what) {
    problems.add(what, scene.file.string(), kind + " '" + name + "'");
  };
  const std::string too_far =
      fmt::format("reaches further than {:g} from the world's origin", kLargestCoordinate);
  for (const Instance& instance : scene.instances)
    if (!within(instance, scene.meshes[instance.mesh].bounds)) refuse("node", instance.name, too_far);
  for (const Camera& camera : scene.cameras) {
    if (!within(glm::dvec3(camera.world_from_camera[3]))) refuse("camera", camera.name, too_far);
    const double aspect = camera.aspect.value_or(1.0);
    if (!(aspect <= kLargestAspect && aspect >= 1 / kLargestAspect))
      refuse("camera", camera.name,
             fmt::format("its aspect ratio is {:g}: must be in {:g}..{:g}", aspect, 1 / kLargestAspect,
                         kLargestAspect));
  }
  for (const Light& light : scene.lights) {
    const double side = light.area ? std::max(light.area->width, light.area->height) : 0.0;
    if (!within(glm::dvec3(light.world_from_light[3])) || !(side <= kLargestCoordinate))
      refuse("light", light.name, too_far);
  }
  problems.raise();
}

}  // namespace gnomon
