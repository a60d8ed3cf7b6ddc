// Which casters can throw a shadow on what a camera sees: tests on bounds, which keep what is in doubt. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/light/light_view.h"
#include "engine/light/scene_facts.h"
#include "engine/scene/scene.h"

namespace gnomon {

// The part of space that a camera sees of a scene, as the corners of a frustum, and the planes around it.
class ViewVolume {
 public:
  // `aspect`: width / height. `origin`: what all positions are relative to, so that far scenes lose no
  // digits.
  ViewVolume(const Scene& scene, const Camera& camera, double aspect, const glm::dvec3& origin);

  bool empty() const { return corners_.empty(); }  // no instance is in view
  // View depth of the nearest bounds in view, at least the camera's near plane.
  double nearest() const { return nearest_; }
  double farthest() const { return farthest_; }  // of the farthest bounds in view, at least nearest()

 private:
  friend class LightVolume;
  std::vector<glm::dvec3> corners_;  // near and far: (-x, -y), (x, -y), (x, y), (-x, y)
  double nearest_ = 0, farthest_ = 0;
};

// All segments from a light to what a camera sees: the convex hull of both.
class LightVolume {
 public:
  // `light`: its centre, relative to the view's origin, and w = 1; of a directional light the direction
  // towards it, and w = 0. `around`: how far beyond the hull casters still count, world units.
  LightVolume(const ViewVolume& view, const glm::dvec4& light, double around);

  // May a body with these corners, relative to the same origin, meet it?
  bool meets(const std::array<glm::dvec3, 8>& corners) const;

 private:
  std::vector<glm::dvec4> planes_;  // inside: n x + w >= 0; unit normals
  double around_ = 0;
  bool empty_ = true;
};

// Corners of an instance's bounds, relative to `origin`.
std::array<glm::dvec3, 8> box_corners(const Scene& scene, const Instance& instance, const glm::dvec3& origin);
// Has some plane of what the camera sees, near plane included, all corners outside? `aspect`: width / height.
bool outside_view(const std::array<glm::dvec3, 8>& corners, const glm::dmat4& view_from_corners,
                  const Camera& camera, double aspect);
// A place at the border of what the camera sees, in its frame: `sx`, `sy` are -1 or 1, or between for places
// inside. `half`: half_extent().
glm::dvec3 view_corner(const Camera& camera, const glm::dvec2& half, double sx, double sy, double depth);
// Has some plane of an open pyramid (it looks along -z; tangents of its half angles) all corners outside?
bool outside_pyramid(const std::array<glm::dvec3, 8>& corners, const glm::dmat4& view_from_corners,
                     double half_width, double half_height, double nearest);
// A light as LightVolume takes it.
glm::dvec4 light_place(const Light& light, const glm::dvec3& origin);

// Instances to draw into each view of a shadow map so that everything the camera sees finds its casters.
// `reach`: texels that readers use around a receiver's place; none: anywhere, and only what a view does not
// hold is left out. `shadowless`: lights whose views need none (SceneFacts). [view][instance].
std::vector<std::vector<bool>> casters_in_view(const Scene& scene, const Camera& camera, double aspect,
                                               const std::vector<LightView>& views, uint32_t map_size,
                                               std::optional<uint32_t> reach,
                                               const std::vector<std::string>& shadowless);

}  // namespace gnomon
