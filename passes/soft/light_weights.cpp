// Weights of a light's points, from its shape and emission.
#include "passes/soft/light_weights.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/area_light.h"

namespace gnomon {
namespace {

constexpr int kSide = 16;      // points
constexpr int kShare = 8;      // a side of the grid that finds how much of a cell is on the light
constexpr double kMost = 255;  // of a weight
constexpr double kEven = 0.25, kOdd = 0.75;  // as in shaders/glsl/lib/light_mask.glsl

// Of the cell about a place in [0, 1]^2, v downwards as in maps.
double weight_of(const Scene& scene, const AreaLight& area, glm::dvec2 place) {
  const double half = 0.5 / kSide;
  const auto at = [&](double x, double y) { return place_on(area, {x, 1.0 - y}); };
  const glm::dvec2 low = glm::clamp(place - half, 0.0, 1.0), high = glm::clamp(place + half, 0.0, 1.0);
  double on = 0;
  for (int y = 0; y < kShare; ++y)
    for (int x = 0; x < kShare; ++x) {
      const glm::dvec2 u = glm::mix(low, high, (glm::dvec2(x, y) + 0.5) / double(kShare));
      on += on_light(area, at(u.x, u.y));
    }
  if (!area.emission) return on;
  return on * emission_weight(emission_in(scene, area, at(low.x, high.y), at(high.x, low.y)));
}

std::array<double, size_t(kSide) * kSide> weights_of(const Scene& scene, const Light& light) {
  std::array<double, size_t(kSide) * kSide> weights{};
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const glm::dvec2 place(i + (j % 2 ? kOdd : kEven), j + (i % 2 ? kOdd : kEven));
      weights[size_t(j) * kSide + size_t(i)] =
          has_size(light) ? weight_of(scene, *light.area, place / double(kSide)) : 1.0;
    }
  return weights;
}

}  // namespace

LightWeights light_weights(const Scene& scene, uint32_t light) {
  const auto weights = weights_of(scene, scene.lights[light]);
  const double most = *std::max_element(weights.begin(), weights.end());
  LightWeights result;
  for (uint32_t i = 0; i < weights.size(); ++i) {
    const auto weight = uint32_t(most > 0 ? std::lround(kMost * weights[i] / most) : std::lround(kMost));
    result.total += weight;
    const uint32_t row = i / kSide, bit = i % kSide + (row < LightWeights::kWords ? 0 : kSide);
    for (uint32_t plane = 0; plane < LightWeights::kPlanes; ++plane)
      result.planes[plane][row % LightWeights::kWords] |= (weight >> plane & 1u) << bit;
  }
  return result;
}

}  // namespace gnomon
