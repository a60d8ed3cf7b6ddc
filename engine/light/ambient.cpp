// How bright the sky is beside a scene's lights.
#include "engine/light/ambient.h"

#include <algorithm>
#include <numbers>

namespace gnomon {

glm::dvec3 sky_radiance(const Scene& scene, const Ambient& ambient) {
  constexpr double kNearest = 0.1;  // of the scene's radius
  const glm::dvec3 middle = scene.bounds.empty() ? glm::dvec3(0.0) : scene.bounds.centre();
  const double least = std::max(kNearest * scene.bounds.radius(), 1e-12);
  double sum = 0;
  for (const Light& light : scene.lights) {
    const double brightest = std::max({light.color.r, light.color.g, light.color.b});
    const double way = std::max(glm::distance(glm::dvec3(light.world_from_light[3]), middle), least);
    sum += brightest * light.intensity / (light.type == LightType::directional ? 1.0 : way * way);
  }
  return ambient.share * sum / std::numbers::pi * ambient.sky;
}

double hemisphere_irradiance(double normal_y, double ground) {
  return std::numbers::pi * (0.5 + 0.5 * normal_y + ground * (0.5 - 0.5 * normal_y));
}

}  // namespace gnomon
