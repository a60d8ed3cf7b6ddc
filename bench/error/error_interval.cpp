// The interval of an image's error: its tiles are drawn again and again, with replacement.
#include "bench/error/error_interval.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace gnomon {
namespace {

constexpr uint32_t kTileSide = 40;  // pixels: wider than a penumbra at usual sizes, and divides 1280 x 720
constexpr size_t kDrawings = 400;   // 10 lie beyond each end of the interval
constexpr double kBeyond = 0.025;   // share of the drawings beyond each end
constexpr uint32_t kSeed = 0x9e3779b9;  // any: fixed, so that results repeat

struct Sums {  // over counted pixels
  double pixels = 0, square = 0, absolute = 0, signed_sum = 0, wrongly_lit = 0, wrongly_shadowed = 0;
  void operator+=(const Sums& other) {
    pixels += other.pixels;
    square += other.square;
    absolute += other.absolute;
    signed_sum += other.signed_sum;
    wrongly_lit += other.wrongly_lit;
    wrongly_shadowed += other.wrongly_shadowed;
  }
};

constexpr std::array kNames = {"rmse", "mae", "bias", "misclassified", "wrongly_lit", "wrongly_shadowed"};
using Figures = std::array<double, kNames.size()>;

Figures figures_of(const Sums& sums) {
  const double n = sums.pixels;
  return {std::sqrt(sums.square / n), sums.absolute / n,
          sums.signed_sum / n,        (sums.wrongly_lit + sums.wrongly_shadowed) / n,
          sums.wrongly_lit / n,       sums.wrongly_shadowed / n};
}

std::vector<Sums> sums_of_tiles(const ComparedPlane& plane, uint32_t width, uint32_t height) {
  const uint32_t across = (width + kTileSide - 1) / kTileSide, down = (height + kTileSide - 1) / kTileSide;
  std::vector<Sums> tiles(size_t{across} * down);
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const size_t i = size_t{y} * width + x;
      if (plane.domain[i] != 0) continue;
      const double difference = double(plane.result[i]) - plane.reference[i];
      const bool lit = plane.result[i] >= 0.5f, truly_lit = plane.reference[i] >= 0.5f;
      tiles[size_t{y / kTileSide} * across + x / kTileSide] +=
          {1,          difference * difference,   std::abs(difference),
           difference, double(lit && !truly_lit), double(!lit && truly_lit)};
    }
  }
  return tiles;
}

// Means over the planes that have counted pixels; false when none has.
bool mean_figures(const std::vector<Sums>& planes, Figures& mean) {
  mean = {};
  double count = 0;
  for (const Sums& sums : planes) {
    if (sums.pixels == 0) continue;
    const Figures figures = figures_of(sums);
    for (size_t k = 0; k < mean.size(); ++k) mean[k] += figures[k];
    ++count;
  }
  for (double& figure : mean) figure /= count;
  return count > 0 && std::all_of(mean.begin(), mean.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

std::optional<std::map<std::string, std::array<double, 2>>> error_intervals(
    std::span<const ComparedPlane> planes, uint32_t width, uint32_t height) {
  std::vector<std::vector<Sums>> tiles;
  for (const ComparedPlane& plane : planes) tiles.push_back(sums_of_tiles(plane, width, height));
  std::vector<size_t> used;  // tiles with counted pixels in any plane
  for (size_t t = 0; !tiles.empty() && t < tiles[0].size(); ++t)
    if (std::any_of(tiles.begin(), tiles.end(), [&](const auto& plane) { return plane[t].pixels > 0; }))
      used.push_back(t);
  if (used.empty()) return std::nullopt;
  std::mt19937 generator(kSeed);
  std::array<std::vector<double>, kNames.size()> drawn;
  for (size_t drawing = 0; drawing < kDrawings; ++drawing) {
    std::vector<Sums> sums(tiles.size());
    for (size_t k = 0; k < used.size(); ++k) {
      const size_t tile = used[(uint64_t{generator()} * used.size()) >> 32];
      for (size_t plane = 0; plane < tiles.size(); ++plane) sums[plane] += tiles[plane][tile];
    }
    Figures mean;
    if (!mean_figures(sums, mean)) return std::nullopt;
    for (size_t k = 0; k < mean.size(); ++k) drawn[k].push_back(mean[k]);
  }
  std::map<std::string, std::array<double, 2>> intervals;
  const auto skip = static_cast<size_t>(kBeyond * kDrawings);
  for (size_t k = 0; k < kNames.size(); ++k) {
    std::sort(drawn[k].begin(), drawn[k].end());
    intervals[kNames[k]] = {drawn[k][skip], drawn[k][kDrawings - 1 - skip]};
  }
  return intervals;
}

}  // namespace gnomon
