// Intervals of errors: as wide as tiles drawn at random make them.
#include "bench/error/error_interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace gnomon {
namespace {

constexpr uint32_t width = 800, height = 400;

struct Pixels {
  std::vector<float> result = std::vector<float>(width * height, 0.0f), reference = result;
  std::vector<uint8_t> domain = std::vector<uint8_t>(width * height, 0);
  ComparedPlane plane() const { return {result, reference, domain}; }
};

auto intervals_of(const Pixels& pixels) {
  const ComparedPlane plane = pixels.plane();
  return error_intervals({&plane, 1}, width, height);
}

TEST(ErrorInterval, ConstantErrorHasAnIntervalWithoutWidth) {
  Pixels pixels;
  for (float& value : pixels.result) value = 0.25f;
  const auto intervals = intervals_of(pixels).value();
  for (const char* metric : {"rmse", "mae", "bias"}) {
    EXPECT_NEAR(intervals.at(metric)[0], 0.25, 1e-12) << metric;
    EXPECT_NEAR(intervals.at(metric)[1], 0.25, 1e-12) << metric;
  }
  EXPECT_EQ(intervals.at("misclassified")[1], 0);
}

// Each tile wholly wrong with probability 1/4: the share is binomial over 200 tiles, standard error
// sqrt(0.25 * 0.75 / 200) = 0.0306, so the interval is about 0.12 wide, around the image's own share.
TEST(ErrorInterval, WidthIsThatOfTheTilesNotOfThePixels) {
  Pixels pixels;
  std::mt19937 generator(3);
  std::vector<bool> wrong(20 * 10);
  size_t count = 0;
  for (size_t t = 0; t < wrong.size(); ++t) {
    wrong[t] = generator() % 4 == 0;
    count += wrong[t] ? 1 : 0;
  }
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x)
      pixels.result[y * width + x] = wrong[y / 40 * 20 + x / 40] ? 1.0f : 0.0f;
  const auto interval = intervals_of(pixels).value().at("wrongly_lit");
  const double share = double(count) / double(wrong.size());
  const double expected = 1.96 * std::sqrt(share * (1 - share) / double(wrong.size()));
  EXPECT_NEAR(share - interval[0], expected, 0.2 * expected);
  EXPECT_NEAR(interval[1] - share, expected, 0.2 * expected);
}

TEST(ErrorInterval, RepeatsAndLeavesOutWhatDoesNotCount) {
  Pixels pixels;
  for (size_t i = 0; i < pixels.result.size(); i += 7) pixels.result[i] = 1;
  const auto first = intervals_of(pixels);
  EXPECT_EQ(first, intervals_of(pixels));
  pixels.domain.assign(pixels.domain.size(), 1);
  EXPECT_FALSE(intervals_of(pixels));
  pixels.domain[0] = 0;
  pixels.result[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(intervals_of(pixels));
  EXPECT_FALSE(error_intervals({}, width, height));
}

}  // namespace
}  // namespace gnomon
