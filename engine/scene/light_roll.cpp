// Turns lights about their own axis, as their direction alone says.
#include "engine/scene/light_roll.h"

#include <cmath>

namespace gnomon {
namespace {

constexpr double kRoundingOfTurn = 1e-6;  // of a matrix's element: a few roundings of a quaternion in floats
constexpr double kRounding = 1e-12;       // of an element in doubles; less is zero
constexpr double kSteepest = 0.99;        // sine of the height above which "up" is no longer world y

bool turns_freely(const Light& light) { return !light.moving && light.type != LightType::spot; }

glm::dvec3 without_rounding(glm::dvec3 v) {
  for (int i = 0; i < 3; ++i)
    if (std::abs(v[i]) < kRounding) v[i] = 0;
  return v;
}

// Axes of a light that shines along -z. A point light shines everywhere: the world's.
glm::dmat3 level_axes(const Light& light) {
  if (light.type == LightType::point) return glm::dmat3(1.0);
  const glm::dvec3 z = without_rounding(glm::normalize(glm::dvec3(light.world_from_light[2])));
  const glm::dvec3 up = std::abs(z.y) < kSteepest ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  const glm::dvec3 x = without_rounding(glm::normalize(glm::cross(up, z)));
  return {x, without_rounding(glm::cross(z, x)), z};
}

}  // namespace

void level_lights(Scene& scene) {
  for (Light& light : scene.lights) {
    if (!turns_freely(light)) continue;
    const glm::dmat3 axes = level_axes(light);
    double apart = 0;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        apart = std::max(apart, std::abs(axes[c][r] - light.world_from_light[c][r]));
    if (apart <= kRoundingOfTurn) continue;
    for (int c = 0; c < 3; ++c) light.world_from_light[c] = glm::dvec4(axes[c], 0.0);
  }
}

}  // namespace gnomon
