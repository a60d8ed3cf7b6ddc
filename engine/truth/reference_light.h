// An area light as the points of a scene see it: where shadow rays end, and how much each counts. Internal to
// the reference tracer.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "engine/scene/scene.h"
#include "engine/truth/ray_scene.h"

namespace gnomon {

struct LightSample {
  glm::dvec3 target{0};  // where the shadow ray ends, or its direction (AreaView::infinite())
  double weight = 1;     // luminance of the emission there
};

// The light seen from one point; of the positions' origin. Refers to the AreaSampler it comes from.
//
// A planar shape is sampled uniformly over its area. A sphere is sampled uniformly over its silhouette: the
// points of the disc through its centre, perpendicular to the direction to it, with the radius at which the
// disc's rim is on the tangent cone. Seen from the receiver the sphere fills that cone, and the disc is a
// cross-section of it: uniform points on the disc are uniform in every cross-section. Rays end where they
// enter the sphere. A directional light is the cone of its angular diameter, sampled in the same way.
class AreaView {
 public:
  bool infinite() const { return infinite_; }  // targets are directions
  // True for a point in or on a sphere: nothing can come between.
  bool surrounds() const { return surrounds_; }
  // `u` in [0, 1) x [0, 1); nothing when that point of the bounding rectangle is not on the light (polygons).
  // Low discrepancy is kept.
  std::optional<LightSample> sample(const glm::dvec2& u) const;

 private:
  friend class AreaSampler;
  const Scene* scene_ = nullptr;
  const AreaLight* area_ = nullptr;
  glm::dvec3 receiver_{0}, centre_{0};
  glm::dvec3 edge_x_{0}, edge_y_{0};  // sides of the rectangle around the sampled shape
  bool surrounds_ = false, infinite_ = false;
};

class AreaSampler {
 public:
  // `centre`: the light's, relative to the origin of all positions; of a directional light a unit vector.
  // `scene` and its light, which must have a size, must outlive this. Error for a polygon whose outline has a
  // problem.
  AreaSampler(const Scene& scene, const Light& light, const ShadowTarget& centre);
  AreaView seen_from(const glm::dvec3& receiver) const;

 private:
  AreaView view_;  // of no receiver in particular
};

}  // namespace gnomon
