// Fits cascades to parts of a camera's frustum.
#include "engine/light/cascades.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/light/caster_culling.h"

namespace gnomon {
namespace {

constexpr double kMargin = 0.01;        // of a window's half width
constexpr double kSmallestPart = 1e-4;  // of the whole view's window: no cascade is narrower

// A window on the light's axes, world units about the whole view's middle.
struct Window {
  glm::dvec2 min{1e300}, max{-1e300};
};

// What the camera sees from the depths of `volume`'s nearest bounds to `reach`, as the whole view shows it.
Window window_of(const ViewVolume& volume, const Camera& camera, double aspect,
                 const glm::dmat4& light_from_seen, double reach) {
  const glm::dvec2 half = half_extent(camera, aspect);
  glm::dmat4 turned = camera.world_from_camera;
  turned[3] = glm::dvec4(0.0, 0.0, 0.0, 1.0);
  Window window;
  for (const double depth : {volume.nearest(), reach})
    for (const double sx : {-1.0, 1.0})
      for (const double sy : {-1.0, 1.0}) {
        const glm::dvec2 at(light_from_seen * turned *
                            glm::dvec4(view_corner(camera, half, sx, sy, depth), 1.0));
        window.min = glm::min(window.min, at), window.max = glm::max(window.max, at);
      }
  return window;
}

LightView part_of(const LightView& whole, const Window& window) {
  const glm::dvec2 half(whole.half_width, whole.half_height);
  const glm::dvec2 low = glm::clamp(window.min, -half, half), high = glm::clamp(window.max, -half, half);
  const glm::dvec2 middle = 0.5 * (low + high);
  const glm::dvec2 size = glm::max((0.5 + 0.5 * kMargin) * (high - low), kSmallestPart * half);
  LightView view = whole;
  view.light_from_world = glm::translate(glm::dmat4(1.0), glm::dvec3(-middle, 0.0)) * whole.light_from_world;
  view.half_width = size.x, view.half_height = size.y;
  return view;
}

}  // namespace

std::vector<LightView> cascades(const Scene& scene, const Camera& camera, double aspect,
                                const LightView& whole, const CascadeSplit& split) {
  const glm::dvec3 eye(camera.world_from_camera[3]);
  const ViewVolume volume(scene, camera, aspect, eye);
  if (volume.empty()) return std::vector<LightView>(split.count, whole);
  const glm::dmat4 light_from_eye = whole.light_from_world * glm::translate(glm::dmat4(1.0), eye);
  std::vector<LightView> views;
  for (uint32_t i = 0; i < split.count; ++i) {
    const double reach = volume.farthest() * std::pow(split.ratio, double(split.count - 1 - i));
    views.push_back(
        part_of(whole, window_of(volume, camera, aspect, light_from_eye, std::max(reach, volume.nearest()))));
  }
  return views;
}

}  // namespace gnomon
