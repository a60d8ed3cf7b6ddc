// What a camera shows of the scene in an image.
#include "engine/scene/camera.h"

#include <fmt/format.h>

#include <cmath>

namespace gnomon {
namespace {

double aspect_of(const Camera& camera, double image_aspect) {
  return camera.span ? camera.span->x / camera.span->y : camera.aspect.value_or(image_aspect);
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

bool far_plane_cuts(const Scene& scene, const Camera& camera) {
  if (!camera.far) return false;
  const glm::dmat4 view = glm::inverse(camera.world_from_camera);
  for (const Instance& instance : scene.instances) {
    if (instance.moving || camera.moving) return true;
    const glm::dmat4 placed = view * instance.world_from_object;
    const Bounds& box = scene.meshes[instance.mesh].bounds;
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 corner((i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                              (i & 4) != 0 ? box.max.z : box.min.z);
      if (-(placed * glm::dvec4(corner, 1.0)).z > *camera.far) return true;
    }
  }
  return false;
}

}  // namespace gnomon
