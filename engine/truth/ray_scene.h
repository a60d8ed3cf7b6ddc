// A scene that rays can ask, on Embree in robust mode. Internal to the reference tracer.
//
// Embree works in floats. Vertices are baked in double arithmetic relative to origin(), the eye whose rays
// are asked for: what is near it is exact whatever else the scene holds, however far away. Hits are refined
// in double against the original vertices, and what seems to block a shadow ray at its very start is tested
// again in double.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "engine/scene/scene.h"

namespace gnomon {

struct TriangleId {
  static constexpr uint32_t none = ~0u;
  uint32_t instance = none, triangle = none;
};

struct SurfaceHit {
  double distance = 0;          // in units of the ray's direction
  glm::dvec3 position{0};       // relative to RayScene::origin()
  glm::dvec3 normal{0};         // geometric, unit, turned to the ray's origin on double-sided meshes
  glm::vec3 shading_normal{0};  // interpolated, on the geometric normal's side
  glm::vec3 albedo{0};
  TriangleId triangle;
};

// A shadow ray's end: a point relative to origin(), or for a light infinitely far a direction of any length.
struct ShadowTarget {
  glm::dvec3 value{0};
  bool infinite = false;
};

class RayScene {
 public:
  static constexpr int packet = 8;

  // `scene` must outlive this; `origin`: in the world. Error when Embree fails (out of memory).
  RayScene(const Scene& scene, const glm::dvec3& origin);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  const glm::dvec3& origin() const;
  // How far a shadow ray starts above a point of a triangle, world units: 16 roundings of a float of the
  // point's distance from the origin and of its coordinates in its mesh. Nothing else of the scene counts.
  double shadow_offset(const glm::dvec3& from, TriangleId self) const;

  // The first surface at distance >= t_near. Back faces of single-sided materials and holes of alpha masks
  // are passed.
  std::optional<SurfaceHit> first_hit(const glm::dvec3& from, const glm::dvec3& direction,
                                      double t_near) const;
  // Is something between a surface point (with its normal, on the light's side) and the target? Both sides
  // cast; holes of alpha masks let through; `self`, the triangle the point lies on, is planar and cannot
  // shadow itself.
  bool occluded(const glm::dvec3& from, const glm::dvec3& normal, const ShadowTarget& target,
                TriangleId self) const;
  // The same for up to 8 targets of one point, all of them places or all of them directions (`infinite`): bit
  // i is set when target i is occluded.
  uint32_t occluded(const glm::dvec3& from, const glm::dvec3& normal, const glm::dvec3* targets, int count,
                    bool infinite, TriangleId self) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon
