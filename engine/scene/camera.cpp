// What a camera shows of the scene in an image.
#include "engine/scene/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

double aspect_of(const Camera& camera, double image_aspect) {
  return camera.span ? camera.span->x / camera.span->y : camera.aspect.value_or(image_aspect);
}

// Of an instance's bounds, along the view's axis.
double farthest_depth(const Scene& scene, const Instance& instance, const glm::dmat4& view) {
  const glm::dmat4 placed = view * instance.world_from_object;
  const Bounds& box = scene.meshes[instance.mesh].bounds;
  double farthest = -1e300;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner((i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                            (i & 4) != 0 ? box.max.z : box.min.z);
    farthest = std::max(farthest, -(placed * glm::dvec4(corner, 1.0)).z);
  }
  return farthest;
}

}  // namespace

glm::dvec2 half_extent(const Camera& camera, double image_aspect) {
  const double own = camera.span ? camera.span->y : std::tan(0.5 * camera.fov_y);
  const double aspect = aspect_of(camera, image_aspect);
  const double height = aspect <= image_aspect ? own : own * aspect / image_aspect;
  return {height * image_aspect, height};
}

std::string aspect_warning(const Camera& camera, double image_aspect) {
  const double aspect = aspect_of(camera, image_aspect);
  constexpr double least = 0.005;  // relative; a pixel of an image 200 wide
  if (std::abs(aspect / image_aspect - 1) < least) return {};
  return fmt::format("camera '{}' has an aspect of {:.4g}, the image one of {:.4g}: the image shows more {}",
                     camera.name, aspect, image_aspect,
                     aspect < image_aspect ? "at the sides" : "above and below");
}

double image_scale(const Camera& camera, double image_aspect) {
  return camera.span ? half_extent(camera, image_aspect).y : 1.0;
}

double depth_end(const Scene& scene, const Camera& camera) {
  constexpr double margin = 1e-3;  // so that what lies farthest is not taken for the background
  const glm::dmat4 view = glm::inverse(camera.world_from_camera);
  double farthest = 0;
  for (const Instance& instance : scene.instances)
    if (instance.visible) farthest = std::max(farthest, farthest_depth(scene, instance, view));
  if (camera.far) farthest = std::min(farthest, *camera.far);
  const double range = farthest - camera.near;
  return camera.near + (range > 0 ? range * (1 + margin) : std::max(camera.near, 1.0));
}

bool far_plane_cuts(const Scene& scene, const Camera& camera) {
  if (!camera.far) return false;
  const glm::dmat4 view = glm::inverse(camera.world_from_camera);
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return instance.moving || camera.moving || farthest_depth(scene, instance, view) > *camera.far;
  });
}

}  // namespace gnomon
