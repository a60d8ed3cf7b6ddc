// Error metrics, each in one place with its definition, unit and source.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/image/image.h"

namespace gnomon {

// Over the counted pixels only (mask 0 = counted). A metric that does not apply is absent.
struct ErrorMetrics {
  uint64_t pixels = 0;                           // counted pixels
  uint64_t excluded = 0;                         // the rest
  uint64_t nonfinite = 0;                        // NaN or Inf in the result: a failure, never skipped
  uint64_t out_of_range = 0;                     // outside [0, 1]
  double rmse = 0;                               // sqrt(mean((result - reference)^2))
  double mae = 0;                                // mean |result - reference|
  double max = 0;                                // max |result - reference|
  double bias = 0;                               // mean(result - reference): negative is over-shadowed
  double misclassified = 0;                      // share of pixels with (result >= 0.5) != (reference >= 0.5)
  double wrongly_lit = 0, wrongly_shadowed = 0;  // the two parts of misclassified, as shares
  std::optional<double> penumbra_rmse;           // RMSE where 0 < reference < 1
  std::optional<double> umbra_light;             // mean result where reference is 0
  std::optional<double> leak;                    // the same away from any true edge: light leak
  std::optional<double> over_shadow;             // mean (1 - result) where reference is 1
  std::optional<double> acne;  // share of counted pixels wrongly shadowed away from any true edge
  std::optional<double> ssim;  // Wang et al. 2004, 11x11 Gaussian window, sigma 1.5, L = 1; 1 = equal
  std::optional<double> flip;  // Andersson et al. 2020, LDR, mean, on the shaded image; 0 = equal
};

// `result` and `reference`: visibility, width*height; `domain`: 0 = counted.
ErrorMetrics compare_visibility(std::span<const float> result, std::span<const float> reference,
                                std::span<const uint8_t> domain, uint32_t width, uint32_t height);

// A frame of a sequence: visibility, reference and domain (0 = counted), width*height each.
struct SequenceImages {
  std::span<const float> result, reference;
  std::span<const uint8_t> domain;
};
// Where a pixel's point was in the frame before.
constexpr uint32_t kNotSeenBefore = UINT32_MAX;
// How much the error changes from one frame to the next where a point is seen in both: mean
// |(result - reference) - (result before - reference before)| over the counted pixels whose point was counted
// in the frame before. The shadow's own movement cancels out; what remains is popping, swimming and noise.
// `before_of`: for each pixel its point's pixel in the frame before, or kNotSeenBefore. Absent without such
// pixels; NaN where a result is not finite.
std::optional<double> flicker(const SequenceImages& now, const SequenceImages& before,
                              std::span<const uint32_t> before_of);

double ssim(std::span<const float> a, std::span<const float> b, uint32_t width, uint32_t height);
// Linear RGB images of the same size. `pixels_per_degree`: 67 by default (0.7 m from a 0.7 m wide 4K
// monitor).
double flip(const Image& test, const Image& reference, double pixels_per_degree = 67.0);

struct MetricInfo {
  std::string name, definition, unit, source;
};
const std::vector<MetricInfo>& metric_infos();  // `gnomon list metrics`

}  // namespace gnomon
