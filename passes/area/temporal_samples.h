// The point samples of an area light that one frame after the other renders.
#pragma once

#include <cstdint>

#include "engine/base/sobol.h"
#include "engine/scene/scene.h"
#include "passes/area/sample_maps.h"

namespace gnomon {

// An Owen-scrambled Sobol sequence over a light: the points of area_points(..., AreaPattern::sobol, light),
// without those that do not shine. A point's weight is its emission relative to the light's mean. The centre
// alone when the light has no area.
class LightSequence {
 public:
  LightSequence(const Scene& scene, uint32_t light);
  // The `index`-th point of the light, 0, 1, ...; fast for the same one or the next.
  LightPoint at(const Scene& scene, uint32_t index);

 private:
  LightPoint next(const AreaLight& area, const Scene& scene);

  uint32_t light_;
  double mean_ = 1;       // emission
  SobolPoints sobol_{0};  // the sequence has no end
  uint32_t points_ = 0;   // found so far, the last of them:
  LightPoint last_{glm::dvec2(0.0), 1.0};
  uint32_t position_ = 0;  // in the sequence
};

}  // namespace gnomon
