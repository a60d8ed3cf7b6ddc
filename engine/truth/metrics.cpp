// Error metrics of visibility images, and flicker of sequences.
#include "engine/truth/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/base/error.h"

namespace gnomon {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void require_size(size_t got, size_t expected, const char* what) {
  if (got != expected) fail(fmt::format("{} has {} pixels, {} expected", what, got, expected));
}

// Mean that is absent when nothing was added.
struct Mean {
  double sum = 0;
  uint64_t count = 0;
  void add(double value) { sum += value, ++count; }
  double value() const { return count ? sum / static_cast<double>(count) : kNan; }
  std::optional<double> optional() const { return count ? std::optional(value()) : std::nullopt; }
};

constexpr int kSsimRadius = 5;  // an 11 x 11 window
using Kernel = std::array<double, 2 * kSsimRadius + 1>;

Kernel ssim_kernel() {
  Kernel kernel{};
  for (int i = -kSsimRadius; i <= kSsimRadius; ++i)
    kernel[i + kSsimRadius] = std::exp(-i * i / (2 * 1.5 * 1.5));
  return kernel;
}

// Weighted mean along one axis; the window is clipped to the image and its weights renormalised.
// `stride` between neighbours on the axis, `length` pixels on it, `index` of the pixel on it.
double window_mean(const double* pixel, int64_t stride, int index, int length, const Kernel& kernel) {
  double sum = 0, weight = 0;
  for (int i = std::max(-kSsimRadius, -index); i <= std::min(kSsimRadius, length - 1 - index); ++i) {
    sum += kernel[i + kSsimRadius] * pixel[i * stride];
    weight += kernel[i + kSsimRadius];
  }
  return sum / weight;
}

std::vector<double> blur(const std::vector<double>& image, int width, int height, const Kernel& kernel) {
  std::vector<double> rows(image.size()), result(image.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t i = size_t(y) * width + x;
      rows[i] = window_mean(&image[i], 1, x, width, kernel);
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t i = size_t(y) * width + x;
      result[i] = window_mean(&rows[i], width, y, height, kernel);
    }
  return result;
}

// Wang et al. 2004, eq. 13, with alpha = beta = gamma = 1 and C3 = C2 / 2, for every pixel.
std::vector<double> ssim_map(std::span<const float> a, std::span<const float> b, int width, int height) {
  const Kernel kernel = ssim_kernel();
  const auto filtered = [&](const auto& value) {
    std::vector<double> image(a.size());
    for (size_t i = 0; i < a.size(); ++i) image[i] = value(double{a[i]}, double{b[i]});
    return blur(image, width, height, kernel);
  };
  const auto mean_a = filtered([](double x, double) { return x; });
  const auto mean_b = filtered([](double, double y) { return y; });
  const auto square_a = filtered([](double x, double) { return x * x; });
  const auto square_b = filtered([](double, double y) { return y * y; });
  const auto product = filtered([](double x, double y) { return x * y; });
  constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;  // (K1 L)^2, (K2 L)^2 with L = 1
  std::vector<double> map(a.size());
  for (size_t i = 0; i < map.size(); ++i) {
    const double ma = mean_a[i], mb = mean_b[i];
    const double variances = square_a[i] - ma * ma + square_b[i] - mb * mb;
    const double covariance = product[i] - ma * mb;
    map[i] = (2 * ma * mb + c1) * (2 * covariance + c2) / ((ma * ma + mb * mb + c1) * (variances + c2));
  }
  return map;
}

// Excluded pixels take the reference's value, so that they neither add nor hide a difference.
double ssim_over_domain(std::span<const float> result, std::span<const float> reference,
                        std::span<const uint8_t> domain, uint32_t width, uint32_t height) {
  std::vector<float> masked(result.begin(), result.end());
  for (size_t i = 0; i < masked.size(); ++i)
    if (domain[i] != 0) masked[i] = reference[i];
  const auto map = ssim_map(masked, reference, static_cast<int>(width), static_cast<int>(height));
  Mean mean;
  for (size_t i = 0; i < map.size(); ++i)
    if (domain[i] == 0) mean.add(map[i]);
  return mean.value();
}

void count_pixels(ErrorMetrics& m, std::span<const float> result, std::span<const uint8_t> domain) {
  for (size_t i = 0; i < result.size(); ++i) {
    ++(domain[i] == 0 ? m.pixels : m.excluded);
    if (!std::isfinite(result[i]))
      ++m.nonfinite;
    else if (result[i] < 0 || result[i] > 1)
      ++m.out_of_range;
  }
}

// No figure can be given: an image with a NaN must not look good, an empty domain must not look perfect.
void set_undefined(ErrorMetrics& m) {
  m.rmse = m.mae = m.max = m.bias = m.misclassified = m.wrongly_lit = m.wrongly_shadowed = kNan;
  if (m.nonfinite > 0) m.penumbra_rmse = m.umbra_light = m.over_shadow = m.ssim = kNan;
}

}  // namespace

ErrorMetrics compare_visibility(std::span<const float> result, std::span<const float> reference,
                                std::span<const uint8_t> domain, uint32_t width, uint32_t height) {
  const size_t size = size_t{width} * height;
  require_size(result.size(), size, "the result");
  require_size(reference.size(), size, "the reference");
  require_size(domain.size(), size, "the domain");
  ErrorMetrics m;
  count_pixels(m, result, domain);
  if (m.nonfinite > 0 || m.pixels == 0) {
    set_undefined(m);
    return m;
  }
  Mean square, absolute, signed_error, lit, shadowed, penumbra, umbra_light, over_shadow;
  for (size_t i = 0; i < size; ++i) {
    if (domain[i] != 0) continue;
    const double r = result[i], truth = reference[i], error = r - truth;
    square.add(error * error);
    absolute.add(std::abs(error));
    signed_error.add(error);
    m.max = std::max(m.max, std::abs(error));
    lit.add(r >= 0.5 && truth < 0.5);
    shadowed.add(r < 0.5 && truth >= 0.5);
    if (truth > 0 && truth < 1) penumbra.add(error * error);
    if (truth == 0) umbra_light.add(r);
    if (truth == 1) over_shadow.add(1 - r);
  }
  m.rmse = std::sqrt(square.value());
  m.mae = absolute.value();
  m.bias = signed_error.value();
  m.wrongly_lit = lit.value();
  m.wrongly_shadowed = shadowed.value();
  m.misclassified = m.wrongly_lit + m.wrongly_shadowed;
  if (penumbra.count) m.penumbra_rmse = std::sqrt(penumbra.value());
  m.umbra_light = umbra_light.optional();
  m.over_shadow = over_shadow.optional();
  m.ssim = ssim_over_domain(result, reference, domain, width, height);
  return m;
}

std::optional<double> flicker(const SequenceImages& now, const SequenceImages& before,
                              std::span<const uint32_t> before_of) {
  const size_t size = before_of.size();
  for (const SequenceImages* frame : {&now, &before}) {
    require_size(frame->result.size(), size, "the result");
    require_size(frame->reference.size(), size, "the reference");
    require_size(frame->domain.size(), size, "the domain");
  }
  Mean change;
  for (size_t i = 0; i < size; ++i) {
    const size_t k = before_of[i];
    if (k == kNotSeenBefore || now.domain[i] != 0 || before.domain[k] != 0) continue;
    const double error = double(now.result[i]) - now.reference[i];
    const double error_before = double(before.result[k]) - before.reference[k];
    change.add(std::abs(error - error_before));
  }
  if (change.count > 0 && !std::isfinite(change.sum)) return kNan;
  return change.optional();
}

double ssim(std::span<const float> a, std::span<const float> b, uint32_t width, uint32_t height) {
  const size_t size = size_t{width} * height;
  require_size(a.size(), size, "the first image");
  require_size(b.size(), size, "the second image");
  Mean mean;
  for (const double value : ssim_map(a, b, static_cast<int>(width), static_cast<int>(height)))
    mean.add(value);
  return mean.value();
}

const std::vector<MetricInfo>& metric_infos() {
  static const std::string own = "definition";
  static const std::vector<MetricInfo> infos = {
      {"rmse", "sqrt(mean((result - reference)^2)) over counted pixels", "visibility, 0..1", own},
      {"mae", "mean |result - reference| over counted pixels", "visibility, 0..1", own},
      {"max", "max |result - reference| over counted pixels", "visibility, 0..1", own},
      {"bias", "mean(result - reference) over counted pixels; negative is over-shadowed", "visibility, -1..1",
       own},
      {"misclassified", "share of counted pixels with (result >= 0.5) != (reference >= 0.5)", "share, 0..1",
       own},
      {"wrongly_lit", "share of counted pixels with result >= 0.5 and reference < 0.5", "share, 0..1", own},
      {"wrongly_shadowed", "share of counted pixels with result < 0.5 and reference >= 0.5", "share, 0..1",
       own},
      {"penumbra_rmse", "RMSE over counted pixels with 0 < reference < 1; absent without any",
       "visibility, 0..1", own},
      {"umbra_light", "mean result over counted pixels with reference = 0; absent without any",
       "visibility, 0..1", own},
      {"leak",
       "mean result over counted pixels with reference = 0 whose tangent plane is in umbra everywhere within "
       "16 shadow texels, of which an even sample is looked at; absent without any",
       "visibility, 0..1", own},
      {"over_shadow", "mean (1 - result) over counted pixels with reference = 1; absent without any",
       "visibility, 0..1", own},
      {"acne",
       "share of counted pixels with result < 0.5 and reference = 1 whose tangent plane is lit everywhere "
       "within two "
       "shadow texels",
       "share, 0..1", own},
      {"ssim",
       "structural similarity of the visibility, 11 x 11 Gaussian window (sigma 1.5, clipped to the image), "
       "K1 0.01, "
       "K2 0.03, L 1; excluded pixels take the reference's value; mean over counted pixels",
       "-1..1, 1 is equal", "Wang, Bovik, Sheikh, Simoncelli 2004, IEEE TIP 13(4), eq. 13"},
      {"flicker",
       "of a frame of a sequence: mean |error - error in the frame before| over counted pixels whose point "
       "was "
       "counted there, error = result - reference; the shadow's own movement cancels out",
       "visibility, 0..1", "definition; compare the warping error of Lai et al. 2018, ECCV"},
      {"flip", "mean LDR-FLIP of the shaded images at 67 pixels per degree", "0..1, 0 is equal",
       "Andersson et al. 2020, Proc. ACM CGIT 3(2)"},
      {"pixels", "counted pixels: geometry, geometric normal towards the light, inside the light's frustum",
       "pixels", own},
      {"excluded", "the other pixels", "pixels", own},
      {"nonfinite", "NaN or Inf anywhere in the result; any makes every error NaN", "pixels", own},
      {"out_of_range", "finite results outside [0, 1]", "pixels", own},
  };
  return infos;
}

}  // namespace gnomon
