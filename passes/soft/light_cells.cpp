// Shapes and textures of lights as weights of the cells of a grid.
#include "passes/soft/light_cells.h"

#include <algorithm>

#include "engine/scene/area_light.h"

namespace gnomon {
namespace {

constexpr int kShare = 8;  // a side of the grid that finds how much of a cell is on a polygon

double share_on(const AreaLight& area, const glm::dvec2& low, const glm::dvec2& high) {
  if (area.shape != AreaLight::Shape::polygon) return 1;
  int on = 0;
  for (int y = 0; y < kShare; ++y)
    for (int x = 0; x < kShare; ++x) {
      const glm::dvec2 u = (glm::dvec2(x, y) + 0.5) / double(kShare);
      on += on_light(area, glm::mix(low, high, u));
    }
  return double(on) / (kShare * kShare);
}

}  // namespace

bool has_uneven_cells(const Light& light) {
  return has_size(light) && (light.area->shape == AreaLight::Shape::polygon || light.area->emission);
}

std::vector<float> light_cells(const Scene& scene, const Light& light) {
  constexpr size_t kCells = size_t(kLightCells) * kLightCells;
  if (!has_uneven_cells(light)) return std::vector<float>(kCells, 1.0f);
  std::vector<double> weights;
  for (uint32_t row = 0; row < kLightCells; ++row)
    for (uint32_t column = 0; column < kLightCells; ++column) {
      const double left = double(column) / kLightCells, top = 1 - double(row) / kLightCells;
      const glm::dvec2 low = place_on(*light.area, {left, top - 1.0 / kLightCells});
      const glm::dvec2 high = place_on(*light.area, {left + 1.0 / kLightCells, top});
      const double emission =
          light.area->emission ? emission_weight(emission_in(scene, *light.area, low, high)) : 1.0;
      weights.push_back(emission * share_on(*light.area, low, high));
    }
  const double most = *std::max_element(weights.begin(), weights.end());
  std::vector<float> result(kCells, 1.0f);
  if (most > 0)
    std::transform(weights.begin(), weights.end(), result.begin(), [&](double w) { return float(w / most); });
  return result;
}

}  // namespace gnomon
