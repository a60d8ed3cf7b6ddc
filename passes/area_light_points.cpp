#include "passes/area_light_points.h"

#include "engine/area_light.h"

namespace gnomon {
namespace {

AreaPattern pattern_of(const std::string& name) {
  if (name == "sobol") return AreaPattern::sobol;
  return name == "grid_centres" ? AreaPattern::grid_centres : AreaPattern::grid_corners;
}

}  // namespace

std::vector<LightPoint> light_points(const Scene& scene, uint32_t index, uint32_t n, const std::string& pattern) {
  const Light& light = scene.lights[index];
  if (!shines_as_area(light)) return {{glm::dvec2(0.0), 1.0}};
  std::vector<LightPoint> points;
  for (const glm::dvec2& local : area_points(*light.area, n, pattern_of(pattern), index))
    points.push_back({local, emission_weight(emission_at(scene, *light.area, local))});
  return points;
}

}  // namespace gnomon
