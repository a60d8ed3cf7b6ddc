// How much each of the points that shaders/glsl/lib/light_mask.glsl knows of a light counts: light shapes and
// textured lights as weights.
#pragma once

#include <array>
#include <cstdint>

#include "engine/scene/scene.h"

namespace gnomon {

// Weights of 0 to 255 for 16x16 points, the greatest of them 255, by bits: plane b holds bit b of each, in
// the order of a mask's words.
struct LightWeights {
  static constexpr uint32_t kPlanes = 8, kWords = 8;
  uint32_t total = 0;  // sum of the weights
  std::array<std::array<uint32_t, kWords>, kPlanes> planes{};
};

// A point's weight is the emission of its cell, that is of a square of a 16th of the bounding rectangle about
// it, times the share of it that is on the light; all the same of a light without area.
LightWeights light_weights(const Scene& scene, uint32_t light);

}  // namespace gnomon
