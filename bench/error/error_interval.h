// How much the error of an image depends on which parts of it are looked at.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

// One light's channel: visibility of the technique and of the reference, and what counts (0 = counted);
// width * height each.
struct ComparedPlane {
  std::span<const float> result, reference;
  std::span<const uint8_t> domain;
};

// 95 % intervals of the means over the planes' counted pixels, {"rmse": [low, high], ...} for rmse, mae,
// bias, misclassified, wrongly_lit and wrongly_shadowed; of several planes that of the mean over them. An
// error is exact for its image; it is a sample when the image stands for a scene: another part of the view,
// or another view, has other edges. The image is cut into tiles, as many tiles are drawn from it with
// replacement, and the interval holds the middle 95 % of the figures of 400 such drawings (block bootstrap,
// Efron and Tibshirani 1993, ch. 8 and 13; whole tiles, since neighbouring pixels err together). The drawings
// are the same for every technique, and in every run. Nothing without counted pixels or with values that are
// not finite.
std::optional<std::map<std::string, std::array<double, 2>>> error_intervals(
    std::span<const ComparedPlane> planes, uint32_t width, uint32_t height);

}  // namespace gnomon
