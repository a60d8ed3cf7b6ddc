// The pre-filter against plain sums on the CPU: every kernel, size and layer,
// borders included.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using hard_shadow::device;

// A spot, a directional and a point light: eight faces.
Scene three_lights() {
  Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {1.5, 7, 1}));
  scene.lights.push_back(analytic::light(LightType::directional, {-3, 5, 2}));
  scene.lights.push_back(analytic::light(LightType::point, {-4, 4, -3}));
  return scene;
}

struct Filtered {
  Image source, result;
};

Filtered run(const std::string& graph, const Values& set) {
  static const auto scene = std::make_shared<Scene>(three_lights());
  const size_t messages = validation_messages(*device()).size();
  RenderSettings s;
  s.width = s.height = 16;
  s.captures = {"moments.moments", "filter.result"};
  Renderer renderer(device(), scene, load_graph(find_graph(graph), set), s);
  renderer.render(TimingMode::none);
  const auto& all = validation_messages(*device());
  for (size_t i = messages; i < all.size(); ++i) ADD_FAILURE() << all[i];
  return {renderer.read("moments.moments"), renderer.read("filter.result")};
}

std::vector<double> weights(int kernel, bool gaussian) {
  std::vector<double> w(static_cast<size_t>(kernel), 1.0);
  double sum = 0;
  for (int i = 0; i < kernel; ++i) {
    const double x = (i - kernel / 2) / (0.25 * kernel);  // standard deviations
    if (gaussian) w[size_t(i)] = std::exp(-0.5 * x * x);
    sum += w[size_t(i)];
  }
  for (double& v : w) v /= sum;
  return w;
}

// One direction; in log space, with `exponent`, of e^(exponent z).
std::vector<double> filter_line(const std::vector<double>& line, const std::vector<double>& w,
                                double exponent) {
  const int n = int(line.size()), radius = int(w.size()) / 2;
  std::vector<double> out(line.size());
  for (int i = 0; i < n; ++i) {
    double sum = 0;
    for (int k = -radius; k <= radius; ++k) {
      const double v = line[size_t(std::clamp(i + k, 0, n - 1))];
      sum += w[size_t(k + radius)] * (exponent > 0 ? std::exp(exponent * (v - 1)) : v);
    }
    out[size_t(i)] = exponent > 0 ? 1 + std::log(sum) / exponent : sum;
  }
  return out;
}

std::vector<double> filter(const Image& image, size_t channel, const std::vector<double>& w,
                           double exponent) {
  const uint32_t width = image.width, height = image.height;
  std::vector<double> all(size_t(width) * height), line(width);
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) line[x] = image.at(x, y, channel);
    const auto row = filter_line(line, w, exponent);
    std::copy(row.begin(), row.end(), all.begin() + std::ptrdiff_t(y) * width);
  }
  line.resize(height);
  for (uint32_t x = 0; x < width; ++x) {
    for (uint32_t y = 0; y < height; ++y) line[y] = all[size_t(y) * width + x];
    const auto column = filter_line(line, w, exponent);
    for (uint32_t y = 0; y < height; ++y) all[size_t(y) * width + x] = column[y];
  }
  return all;
}

enum class Of {
  largest,
  each,
  one
};  // what a tolerance is a part of: the channel's largest value, each value, or 1

void expect_filtered(const Filtered& run, int kernel, bool gaussian, double tolerance, Of of = Of::largest,
                     double exponent = 0) {
  ASSERT_EQ(run.source.channels, run.result.channels);
  const auto w = weights(kernel, gaussian);
  for (size_t channel = 0; channel < run.source.channels.size(); ++channel) {
    const auto expected = filter(run.source, channel, w, exponent);
    const auto result = run.result.plane(channel);
    double most = 1e-30, worst = 0;
    for (const double v : expected) most = std::max(most, std::abs(v));
    for (size_t i = 0; i < expected.size(); ++i) {
      const double whole = of == Of::one ? 1 : of == Of::each ? std::max(std::abs(expected[i]), 1e-30) : most;
      worst = std::max(worst, std::abs(result[i] - expected[i]) / whole);
    }
    EXPECT_LE(worst, tolerance) << run.source.channels[channel] << ", kernel " << kernel << ", "
                                << run.source.width;
  }
}

// Two passes of at most 63 roundings each, of 2^-24.
constexpr double kRounding = 126.0 / (1 << 24);

TEST(Prefilter, BoxIsTheMeanOfTheTexels) {
  for (const int size : {65, 128, 203})
    for (const int kernel : {1, 3, 7, 15, 17, 31, 33, 63})
      expect_filtered(run("vsm", {{"shadow_map", int64_t(size)}, {"kernel", int64_t(kernel)}}), kernel, false,
                      kRounding);
}

TEST(Prefilter, KernelsLargerThanTheMapRepeatItsBorder) {
  for (const int kernel : {15, 63})
    expect_filtered(run("msm", {{"shadow_map", int64_t(33)}, {"kernel", int64_t(kernel)}}), kernel, false,
                    kRounding);
}

TEST(Prefilter, GaussianIsTheWeightedMeanOfTheTexels) {
  for (const int size : {65, 130})
    for (const int kernel : {3, 15, 63})
      expect_filtered(
          run("vsm", {{"shadow_map", int64_t(size)}, {"kernel", int64_t(kernel)}, {"shape", "gaussian"}}),
          kernel, true, 2 * kRounding);
}

// Values that span 38 orders of magnitude: each mean keeps its own digits,
// however bright its neighbours in the map were.
TEST(Prefilter, DarkTexelsKeepTheirDigitsBesideBrightOnes) {
  expect_filtered(run("esm", {{"shadow_map", int64_t(128)}, {"kernel", int64_t(15)}, {"exponent", 88.0}}), 15,
                  false, kRounding, Of::each);
}

TEST(Prefilter, LogSpaceIsTheLogarithmOfTheMeanExponential) {
  for (const char* shape : {"box", "gaussian"})
    for (const double exponent : {1.0, 88.0, 600.0})
      expect_filtered(run("esm", {{"shadow_map", int64_t(97)},
                                  {"kernel", int64_t(15)},
                                  {"exponent", exponent},
                                  {"space", "log"},
                                  {"shape", shape}}),
                      15, shape == std::string("gaussian"), 1e-5, Of::largest, exponent);
}

TEST(Prefilter, EveryLayerOfAFaceIsFiltered) {
  const Filtered csm = run(
      "csm",
      {{"shadow_map", int64_t(70)}, {"kernel", int64_t(7)}, {"terms", int64_t(5)}, {"precision", "single"}});
  EXPECT_EQ(csm.source.channels.size(), 8u * 3 * 4);
  expect_filtered(csm, 7, false, kRounding);
}

TEST(Prefilter, SixteenBitsRoundToTheirStep) {
  // A rounding of each pass, which for floats is a part of values up to half as large again as the largest
  // mean.
  constexpr double kHalfStep = 3.0 / 2048, kUnormStep = 2.0 / 65535;
  expect_filtered(run("vsm", {{"shadow_map", int64_t(65)}, {"kernel", int64_t(15)}, {"precision", "half"}}),
                  15, false, kHalfStep);
  expect_filtered(run("msm", {{"shadow_map", int64_t(65)}, {"kernel", int64_t(15)}, {"precision", "half"}}),
                  15, false, kUnormStep, Of::one);
}

TEST(Prefilter, OneTexelIsLeftOut) {
  RenderSettings s;
  s.width = s.height = 16;
  const auto scene = std::make_shared<Scene>(three_lights());
  const Renderer renderer(
      device(), scene, load_graph(find_graph("vsm"), {{"kernel", int64_t(1)}, {"shadow_map", int64_t(64)}}),
      s);
  const auto left = renderer.left_out();
  EXPECT_TRUE(std::any_of(left.begin(), left.end(), [](const LeftOutPass& p) { return p.pass == "filter"; }));
}

}  // namespace
}  // namespace gnomon
