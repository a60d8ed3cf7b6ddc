// LDR-FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator
// for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020. Constants are the paper's.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>

#include "engine/base/error.h"
#include "engine/truth/metrics.h"

namespace gnomon {
namespace {

using std::numbers::pi;
using Plane = std::vector<double>;
using Kernel = std::vector<double>;  // odd length, centred
using Planes = std::array<Plane, 3>;

constexpr double kColorExponent = 0.7;    // q_c
constexpr double kFeatureExponent = 0.5;  // q_f
constexpr double kSplitColor = 0.4;       // p_c
constexpr double kSplitError = 0.95;      // p_t
constexpr double kFeatureWidth = 0.082;   // w, degrees

struct Size {
  int width = 0, height = 0;
};

// Columns: linear sRGB primaries in CIE XYZ (D65).
const glm::dmat3 xyz_from_rgb{10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382,
                              8788810.0 / 24577794,  8788810.0 / 12288897, 8788810.0 / 73733382,
                              4435075.0 / 24577794,  887015.0 / 12288897,  70074185.0 / 73733382};
const glm::dmat3 rgb_from_xyz = glm::inverse(xyz_from_rgb);
const glm::dvec3 white = xyz_from_rgb * glm::dvec3(1.0);

// Linearised CIELAB: achromatic, red-green, blue-yellow (section 4.1.1).
glm::dvec3 ycxcz_from_rgb(const glm::dvec3& rgb) {
  const glm::dvec3 n = xyz_from_rgb * rgb / white;
  return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}

glm::dvec3 rgb_from_ycxcz(const glm::dvec3& c) {
  const double y = (c.x + 16) / 116;
  return rgb_from_xyz * (glm::dvec3(y + c.y / 500, y, y - c.z / 200) * white);
}

double lab_curve(double t) {
  constexpr double delta = 6.0 / 29;
  return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

// CIELAB with the Hunt effect: chroma scaled by lightness (eq. 4).
glm::dvec3 hunt_lab_from_rgb(const glm::dvec3& rgb) {
  const glm::dvec3 n = xyz_from_rgb * rgb / white;
  const double fx = lab_curve(n.x), fy = lab_curve(n.y), fz = lab_curve(n.z);
  const double lightness = 116 * fy - 16;
  return {lightness, 0.01 * lightness * 500 * (fx - fy), 0.01 * lightness * 200 * (fy - fz)};
}

double hyab(const glm::dvec3& a, const glm::dvec3& b) {  // Abasi et al. 2020
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// Convolution with kx along x and ky along y; the border pixels are repeated outside.
Plane convolve(const Plane& image, Size size, const Kernel& kx, const Kernel& ky) {
  Plane rows(image.size()), result(image.size());
  const int rx = static_cast<int>(kx.size() / 2), ry = static_cast<int>(ky.size() / 2);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      double sum = 0;
      for (int i = -rx; i <= rx; ++i)
        sum += kx[i + rx] * image[size_t(y) * size.width + std::clamp(x + i, 0, size.width - 1)];
      rows[size_t(y) * size.width + x] = sum;
    }
  for (int i = -ry; i <= ry; ++i)
    for (int y = 0; y < size.height; ++y) {
      const double* source = &rows[size_t(std::clamp(y + i, 0, size.height - 1)) * size.width];
      double* target = &result[size_t(y) * size.width];
      for (int x = 0; x < size.width; ++x) target[x] += ky[i + ry] * source[x];
    }
  return result;
}

Kernel sample_kernel(int radius, const std::function<double(double)>& f) {
  Kernel kernel(2 * radius + 1);
  for (int i = -radius; i <= radius; ++i) kernel[i + radius] = f(i);
  return kernel;
}

double sum(const Kernel& kernel) {
  double total = 0;
  for (const double k : kernel) total += k;
  return total;
}

// One Gaussian of a contrast sensitivity function in the spatial domain (eq. 2): a sqrt(pi / b) exp(-pi^2 d^2
// / b).
struct SensitivityTerm {
  double a, b;
};

Plane filter_sensitivity(const Plane& image, Size size, std::span<const SensitivityTerm> terms,
                         double pixels_per_degree) {
  // The widest b of all three channels sets one radius of three standard deviations.
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * pixels_per_degree));
  Plane result(image.size());
  double total = 0;
  for (const auto [a, b] : terms) {
    const Kernel k = sample_kernel(radius, [&, b = b](double i) {
      const double d = i / pixels_per_degree;
      return std::exp(-pi * pi * d * d / b);
    });
    const double scale = a * std::sqrt(pi / b);
    const Plane part = convolve(image, size, k, k);
    for (size_t i = 0; i < result.size(); ++i) result[i] += scale * part[i];
    total += scale * sum(k) * sum(k);
  }
  for (double& value : result) value /= total;
  return result;
}

// Preprocessed color: filtered by the contrast sensitivity functions of table 1, clamped to the displayable
// cube.
std::vector<glm::dvec3> perceived_color(const Planes& ycxcz, Size size, double pixels_per_degree) {
  const SensitivityTerm achromatic[] = {{1, 0.0047}};
  const SensitivityTerm red_green[] = {{1, 0.0053}};
  const SensitivityTerm blue_yellow[] = {{34.1, 0.04}, {13.5, 0.025}};
  const Plane y = filter_sensitivity(ycxcz[0], size, achromatic, pixels_per_degree);
  const Plane cx = filter_sensitivity(ycxcz[1], size, red_green, pixels_per_degree);
  const Plane cz = filter_sensitivity(ycxcz[2], size, blue_yellow, pixels_per_degree);
  std::vector<glm::dvec3> result(y.size());
  for (size_t i = 0; i < result.size(); ++i)
    result[i] = hunt_lab_from_rgb(glm::clamp(rgb_from_ycxcz({y[i], cx[i], cz[i]}), 0.0, 1.0));
  return result;
}

// The perceptible range of color differences is stretched over [0, 1] (eq. 6).
double redistribute(double difference) {
  static const double largest =
      std::pow(hyab(hunt_lab_from_rgb({0, 1, 0}), hunt_lab_from_rgb({0, 0, 1})), kColorExponent);
  const double value = std::pow(difference, kColorExponent), split = kSplitColor * largest;
  if (value < split) return kSplitError / split * value;
  return kSplitError + (value - split) / (largest - split) * (1 - kSplitError);
}

// Positive weights sum to 1, negative ones to -1.
void normalize_feature(Kernel& kernel) {
  double positive = 0, negative = 0;
  for (const double k : kernel) (k > 0 ? positive : negative) += std::abs(k);
  for (double& k : kernel) k /= k > 0 ? positive : negative;
}

// Magnitudes of edges (first derivative of a Gaussian) or points (second derivative), section 4.2.
Plane features(const Plane& luminance, Size size, double pixels_per_degree, bool edges) {
  const double sigma = 0.5 * kFeatureWidth * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const auto gauss = [&](double i) { return std::exp(-i * i / (2 * sigma * sigma)); };
  Kernel smooth = sample_kernel(radius, gauss);
  const double total = sum(smooth);
  for (double& k : smooth) k /= total;
  Kernel detect =
      sample_kernel(radius, [&](double i) { return gauss(i) * (edges ? -i : i * i / (sigma * sigma) - 1); });
  normalize_feature(detect);
  const Plane dx = convolve(luminance, size, detect, smooth);
  const Plane dy = convolve(luminance, size, smooth, detect);
  Plane magnitude(dx.size());
  for (size_t i = 0; i < dx.size(); ++i) magnitude[i] = std::hypot(dx[i], dy[i]);
  return magnitude;
}

Plane luminance_of(const Plane& y) {
  Plane result(y.size());
  std::transform(y.begin(), y.end(), result.begin(), [](double v) { return (v + 16) / 116; });
  return result;
}

Planes opponent_planes(const Image& image) {
  Planes planes;
  for (auto& plane : planes) plane.resize(size_t{image.width} * image.height);
  for (size_t i = 0; i < planes[0].size(); ++i) {
    const glm::dvec3 rgb(image.plane(0)[i], image.plane(1)[i], image.plane(2)[i]);
    const glm::dvec3 c = ycxcz_from_rgb(glm::clamp(rgb, 0.0, 1.0));
    for (int k = 0; k < 3; ++k) planes[k][i] = c[k];
  }
  return planes;
}

void check(const Image& test, const Image& reference, double pixels_per_degree) {
  if (test.channels.size() < 3 || reference.channels.size() < 3)
    fail("FLIP compares RGB images: 3 channels expected");
  if (test.width != reference.width || test.height != reference.height)
    fail(fmt::format("FLIP compares images of one size: {} x {} and {} x {} given", test.width, test.height,
                     reference.width, reference.height));
  if (test.width == 0 || test.height == 0) fail("FLIP of an empty image");
  if (!(pixels_per_degree > 0))
    fail(fmt::format("{} pixels per degree: must be positive", pixels_per_degree));
}

bool finite_rgb(const Image& image) {
  const size_t values = 3 * size_t{image.width} * image.height;
  return std::all_of(image.data.begin(), image.data.begin() + static_cast<std::ptrdiff_t>(values),
                     [](float v) { return std::isfinite(v); });
}

}  // namespace

double flip(const Image& test, const Image& reference, double pixels_per_degree) {
  check(test, reference, pixels_per_degree);
  if (!finite_rgb(test) || !finite_rgb(reference)) return std::numeric_limits<double>::quiet_NaN();
  const Size size{static_cast<int>(test.width), static_cast<int>(test.height)};
  const Planes a = opponent_planes(test), b = opponent_planes(reference);
  const auto color_a = perceived_color(a, size, pixels_per_degree),
             color_b = perceived_color(b, size, pixels_per_degree);
  const Plane luminance_a = luminance_of(a[0]), luminance_b = luminance_of(b[0]);
  const Plane edges_a = features(luminance_a, size, pixels_per_degree, true);
  const Plane edges_b = features(luminance_b, size, pixels_per_degree, true);
  const Plane points_a = features(luminance_a, size, pixels_per_degree, false);
  const Plane points_b = features(luminance_b, size, pixels_per_degree, false);
  double total = 0;
  for (size_t i = 0; i < color_a.size(); ++i) {
    const double color = redistribute(hyab(color_a[i], color_b[i]));
    const double feature = std::max(std::abs(edges_a[i] - edges_b[i]), std::abs(points_a[i] - points_b[i]));
    const double feature_error = std::pow(feature / std::numbers::sqrt2, kFeatureExponent);  // eq. 7
    total += std::pow(color, 1 - feature_error);                                             // eq. 8
  }
  return total / static_cast<double>(color_a.size());
}

}  // namespace gnomon
