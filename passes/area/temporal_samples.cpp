// The point samples of an area light that one frame after the other renders.
#include "passes/area/temporal_samples.h"

#include "engine/scene/area_light.h"
#include "engine/scene/scene.h"

namespace gnomon {

LightSequence::LightSequence(const Scene& scene, uint32_t light) : light_(light) {
  const Light& source = scene.lights.at(light);
  if (shines_as_area(source)) mean_ = emission_weight(mean_emission(scene, *source.area));
}

LightPoint LightSequence::next(const AreaLight& area, const Scene& scene) {
  constexpr uint32_t kMostTries =
      4096;  // a light that shines from less of its rectangle takes a point that does not
  LightPoint point;
  for (uint32_t tries = 0; tries < kMostTries;) {
    point.local = place_on(area, sobol_.scrambled(position_++, light_));
    if (!on_light(area, point.local)) continue;
    point.weight = mean_ > 0 ? emission_weight(emission_at(scene, area, point.local)) / mean_ : 1.0;
    if (point.weight > 0) break;
    ++tries;
  }
  return point;
}

LightPoint LightSequence::at(const Scene& scene, uint32_t index) {
  const Light& light = scene.lights.at(light_);
  if (!shines_as_area(light)) return {glm::dvec2(0.0), 1.0};
  if (index + 1 < points_) points_ = position_ = 0;  // a new sequence of frames
  for (; points_ <= index; ++points_) last_ = next(*light.area, scene);
  return last_;
}

}  // namespace gnomon
