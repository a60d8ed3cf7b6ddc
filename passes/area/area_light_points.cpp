// Point samples of the scene's area lights.
#include "passes/area/area_light_points.h"

#include "engine/scene/area_light.h"
#include "engine/scene/scene.h"

namespace gnomon {
namespace {

AreaPattern pattern_of(const std::string& name) {
  if (name == "sobol") return AreaPattern::sobol;
  return name == "grid_centres" ? AreaPattern::grid_centres : AreaPattern::grid_corners;
}

// Emission times area of a part, as share of the rectangle's; how much of it is on the light by a grid of
// points.
double power_of(const Scene& scene, const AreaLight& area, glm::dvec2 min, glm::dvec2 max) {
  constexpr int kPoints = 16;  // a side
  double on = 0;
  for (int y = 0; y < kPoints; ++y)
    for (int x = 0; x < kPoints; ++x)
      on += on_light(area, place_on(area, glm::mix(min, max, (glm::dvec2(x, y) + 0.5) / double(kPoints))));
  const double share = on / (kPoints * kPoints);
  const double emission =
      area.emission ? emission_weight(emission_in(scene, area, place_on(area, min), place_on(area, max)))
                    : 1.0;
  return share * emission * (max.x - min.x) * (max.y - min.y);
}

}  // namespace

LightSurface light_surface(const Scene& scene, uint32_t light) {
  const AreaLight& area = *scene.lights[light].area;
  if (area.shape == AreaLight::Shape::rectangle && !area.emission) return whole_rectangle();
  return {[&area](glm::dvec2 u) { return on_light(area, place_on(area, u)); },
          [&scene, &area](glm::dvec2 min, glm::dvec2 max) { return power_of(scene, area, min, max); }};
}

std::vector<LightPoint> light_points(const Scene& scene, uint32_t index, uint32_t n,
                                     const std::string& pattern) {
  const Light& light = scene.lights[index];
  if (!shines_as_area(light)) return {{glm::dvec2(0.0), 1.0}};
  std::vector<LightPoint> points;
  for (const glm::dvec2& local : area_points(*light.area, n, pattern_of(pattern), index))
    points.push_back({local, emission_weight(emission_at(scene, *light.area, local))});
  return points;
}

}  // namespace gnomon
