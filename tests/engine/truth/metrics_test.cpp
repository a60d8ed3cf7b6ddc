// Error metrics against values computed by hand.
#include "engine/truth/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "engine/base/error.h"

namespace gnomon {
namespace {

using Values = std::vector<float>;
using Domain = std::vector<uint8_t>;

Image rgb_image(uint32_t width, uint32_t height, float r, float g, float b) {
  Image image(width, height, {"R", "G", "B"});
  const float color[] = {r, g, b};
  for (size_t c = 0; c < 3; ++c)
    for (float& v : image.plane(c)) v = color[c];
  return image;
}

// 2 x 2, all counted. Differences: 0.25, -1, 0, 0.5.
//   rmse = sqrt((1/16 + 1 + 0 + 1/4) / 4) = sqrt(21/64); mae = 1.75 / 4; bias = -0.25 / 4; max = 1
//   pixel 1 is wrongly shadowed, pixel 3 (0.75 against 0.25) wrongly lit
//   penumbra: pixels 0 (0.5) and 3 (0.25): sqrt((1/16 + 1/4) / 2) = sqrt(5/32)
//   leak: pixel 2: 0; over-shadow: pixel 1: 1
TEST(Visibility, TwoByTwoByHand) {
  const ErrorMetrics m =
      compare_visibility(Values{0.75f, 0, 0, 0.75f}, Values{0.5f, 1, 0, 0.25f}, Domain(4, 0), 2, 2);
  EXPECT_EQ(m.pixels, 4u);
  EXPECT_EQ(m.excluded, 0u);
  EXPECT_DOUBLE_EQ(m.rmse, std::sqrt(21.0 / 64));
  EXPECT_DOUBLE_EQ(m.mae, 1.75 / 4);
  EXPECT_DOUBLE_EQ(m.bias, -0.25 / 4);
  EXPECT_DOUBLE_EQ(m.max, 1);
  EXPECT_DOUBLE_EQ(m.misclassified, 0.5);
  EXPECT_DOUBLE_EQ(m.wrongly_lit, 0.25);
  EXPECT_DOUBLE_EQ(m.wrongly_shadowed, 0.25);
  EXPECT_DOUBLE_EQ(*m.penumbra_rmse, std::sqrt(5.0 / 32));
  EXPECT_DOUBLE_EQ(*m.umbra_light, 0);
  EXPECT_DOUBLE_EQ(*m.over_shadow, 1);
  EXPECT_FALSE(m.acne);
  EXPECT_FALSE(m.flip);
}

// Only pixels 0 and 3 count: differences 0.25 and -0.5.
TEST(Visibility, ExcludedPixelsDoNotCount) {
  const ErrorMetrics m =
      compare_visibility(Values{0.25f, 1, 0, 0.5f}, Values{0, 0, 1, 1}, Domain{0, 1, 2, 0}, 2, 2);
  EXPECT_EQ(m.pixels, 2u);
  EXPECT_EQ(m.excluded, 2u);
  EXPECT_DOUBLE_EQ(m.rmse, std::sqrt((1.0 / 16 + 1.0 / 4) / 2));
  EXPECT_DOUBLE_EQ(m.bias, -0.125);
  EXPECT_DOUBLE_EQ(m.misclassified, 0);  // 0.5 counts as lit
  EXPECT_DOUBLE_EQ(*m.umbra_light, 0.25);
  EXPECT_DOUBLE_EQ(*m.over_shadow, 0.5);
  EXPECT_FALSE(m.penumbra_rmse);
}

TEST(Visibility, EqualIsPerfect) {
  const Values v{0, 0.25f, 0.5f, 1};
  const ErrorMetrics m = compare_visibility(v, v, Domain(4, 0), 2, 2);
  EXPECT_EQ(m.rmse, 0);
  EXPECT_EQ(m.max, 0);
  EXPECT_EQ(m.misclassified, 0);
  EXPECT_DOUBLE_EQ(*m.ssim, 1);
}

TEST(Visibility, NonfiniteFailsEvenWhereExcluded) {
  for (const float bad :
       {std::nanf(""), std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()})
    for (const uint8_t domain : {0, 1}) {
      const ErrorMetrics m =
          compare_visibility(Values{bad, 1, 0, 1}, Values{0, 1, 0, 1}, Domain{domain, 0, 0, 0}, 2, 2);
      EXPECT_EQ(m.nonfinite, 1u);
      for (const double v : {m.rmse, m.mae, m.max, m.bias, m.misclassified, m.wrongly_lit, m.wrongly_shadowed,
                             *m.ssim, *m.umbra_light})
        EXPECT_TRUE(std::isnan(v));
    }
}

TEST(Visibility, OutOfRangeIsCounted) {
  const ErrorMetrics m =
      compare_visibility(Values{-0.5f, 1.5f, 0, 1}, Values{0, 1, 0, 1}, Domain(4, 0), 2, 2);
  EXPECT_EQ(m.out_of_range, 2u);
  EXPECT_EQ(m.nonfinite, 0u);
  EXPECT_DOUBLE_EQ(m.max, 0.5);
}

TEST(Visibility, NothingCountedIsNotPerfect) {
  const ErrorMetrics m = compare_visibility(Values{1, 1}, Values{1, 1}, Domain{1, 3}, 2, 1);
  EXPECT_EQ(m.pixels, 0u);
  EXPECT_TRUE(std::isnan(m.rmse));
  EXPECT_FALSE(m.ssim);
}

TEST(Visibility, SizesMustAgree) {
  EXPECT_THROW(compare_visibility(Values(3), Values(4), Domain(4), 2, 2), Error);
  EXPECT_THROW(compare_visibility(Values(4), Values(3), Domain(4), 2, 2), Error);
  EXPECT_THROW(compare_visibility(Values(4), Values(4), Domain(3), 2, 2), Error);
  EXPECT_THROW(ssim(Values(4), Values(3), 2, 2), Error);
}

// Constant images: no variance, so that the second factor is C2 / C2 = 1 and
//   ssim = (2 * 0.25 * 0.75 + C1) / (0.25^2 + 0.75^2 + C1), C1 = 0.0001: 0.3751 / 0.6251.
TEST(Ssim, ConstantImages) {
  EXPECT_NEAR(ssim(Values(16 * 16, 0.25f), Values(16 * 16, 0.75f), 16, 16), 0.3751 / 0.6251, 1e-12);
}

// Two pixels, a = (0, 1), b = (1, 0). The clipped window weighs its own pixel p = 1 / (1 + e), the other q =
// e / (1 + e) with e = exp(-1 / 4.5). At pixel 0: means q and p, both variances p q, covariance -p q; at
// pixel 1 the same mirrored.
TEST(Ssim, TwoPixelsByHand) {
  const double e = std::exp(-1 / 4.5), p = 1 / (1 + e), q = e / (1 + e), c1 = 1e-4, c2 = 9e-4;
  const double expected = (2 * p * q + c1) * (-2 * p * q + c2) / ((p * p + q * q + c1) * (2 * p * q + c2));
  EXPECT_NEAR(ssim(Values{0, 1}, Values{1, 0}, 2, 1), expected, 1e-12);
  EXPECT_NEAR(ssim(Values{0, 1}, Values{1, 0}, 1, 2), expected, 1e-12);
  EXPECT_LT(expected, 0);
}

// A single white pixel in black against black. 13 x 1: only windows within 5 pixels see it. With w(d) the
// normalised weight at distance d: mean w, variance w - w^2, covariance 0, ssim = C1 C2 / ((w^2 + C1) (w -
// w^2 + C2)); else 1.
TEST(Ssim, WindowIsElevenPixelsWide) {
  Values a(13, 0.0f);
  const Values b(13, 0.0f);
  a[6] = 1;
  double sum = 0;
  for (int x = 0; x < 13; ++x) {
    const int d = std::abs(x - 6);
    if (d > 5) {
      sum += 1;
      continue;
    }
    double total = 0;
    for (int i = -5; i <= 5; ++i)
      if (x + i >= 0 && x + i < 13) total += std::exp(-i * i / 4.5);
    const double w = std::exp(-d * d / 4.5) / total;
    sum += 1e-4 * 9e-4 / ((w * w + 1e-4) * (w - w * w + 9e-4));
  }
  EXPECT_NEAR(ssim(a, b, 13, 1), sum / 13, 1e-9);
}

TEST(Ssim, IdenticalIsOneAndSymmetric) {
  Values a(256), b(256);
  for (size_t i = 0; i < a.size(); ++i) a[i] = float(i * 37 % 101) / 101, b[i] = float(i * 53 % 97) / 97;
  EXPECT_DOUBLE_EQ(ssim(a, a, 16, 16), 1);
  EXPECT_DOUBLE_EQ(ssim(a, b, 16, 16), ssim(b, a, 16, 16));
  EXPECT_LT(ssim(a, b, 16, 16), 0.5);
}

TEST(Flip, IdenticalIsZero) {
  Image image = rgb_image(16, 16, 0.3f, 0.6f, 0.1f);
  for (size_t i = 0; i < image.data.size(); ++i) image.data[i] = float(i * 37 % 101) / 101;
  EXPECT_EQ(flip(image, image), 0);
}

// Flat images have neither edges nor points, and a Gaussian keeps a constant: FLIP is the redistributed color
// difference. Black against white: HyAB = 100, 100^0.7 = 25.1189. The largest difference is green against
// blue after Hunt's adjustment: Lab (87.7370, -86.1846, 83.1811) and (32.3026, 79.1967, -107.8637), chroma
// times L/100: (87.7370, -75.6158, 72.9806), (32.3026, 25.5826, -34.8428); HyAB = 55.4344 + hypot(101.1984,
// 107.8234) = 203.3113; c = 203.3113^0.7 = 41.2760, split 0.4 c = 16.5104; 0.95 + 0.05 (25.1189 - 16.5104) /
// (41.2760 - 16.5104) = 0.96738.
TEST(Flip, BlackAgainstWhiteByHand) {
  const Image black = rgb_image(16, 16, 0, 0, 0), white = rgb_image(16, 16, 1, 1, 1);
  EXPECT_NEAR(flip(black, white), 0.96738, 2e-5);
  EXPECT_NEAR(flip(white, black), 0.96738, 2e-5);
}

// Greys are on the first, linear piece. Linear 0.18 has L = 116 * 0.18^(1/3) - 16 = 49.4961; 0.2: 51.8372.
// 2.34111^0.7 = 1.81385; 0.95 / 16.5104 * 1.81385 = 0.104367.
TEST(Flip, NearGreysByHand) {
  EXPECT_NEAR(flip(rgb_image(8, 8, 0.18f, 0.18f, 0.18f), rgb_image(8, 8, 0.2f, 0.2f, 0.2f)), 0.104367, 2e-5);
}

TEST(Flip, LargestColorDifferenceIsOne) {
  EXPECT_NEAR(flip(rgb_image(4, 4, 0, 1, 0), rgb_image(4, 4, 0, 0, 1)), 1, 1e-6);
}

TEST(Flip, IsBoundedAndGrowsWithEdges) {
  Image checker = rgb_image(32, 32, 0, 0, 0), edge = checker;
  const Image gray = rgb_image(32, 32, 0.5f, 0.5f, 0.5f);
  for (uint32_t y = 0; y < 32; ++y)
    for (uint32_t x = 0; x < 32; ++x)
      for (uint32_t c = 0; c < 3; ++c) {
        checker.at(x, y, c) = float((x / 4 + y / 4) % 2);
        edge.at(x, y, c) = x < 16 ? 0.45f : 0.55f;
      }
  for (const Image* image : {&checker, &edge}) {
    EXPECT_GT(flip(*image, gray), 0);
    EXPECT_LE(flip(*image, gray), 1);
    EXPECT_NEAR(flip(*image, gray), flip(gray, *image), 1e-12);  // symmetric by definition
  }
  // The same difference of color everywhere, but with an edge that the reference lacks.
  EXPECT_GT(flip(edge, gray), flip(rgb_image(32, 32, 0.45f, 0.45f, 0.45f), gray));
}

// The closer the viewer (more pixels per degree is further), the more of a fine pattern is seen.
TEST(Flip, FinePatternsBlurWithDistance) {
  Image stripes = rgb_image(64, 64, 0, 0, 0);
  for (uint32_t y = 0; y < 64; ++y)
    for (uint32_t x = 0; x < 64; ++x)
      for (uint32_t c = 0; c < 3; ++c) stripes.at(x, y, c) = float(x % 2);
  const Image gray = rgb_image(64, 64, 0.5f, 0.5f, 0.5f);
  EXPECT_GT(flip(stripes, gray, 20), flip(stripes, gray, 120));
}

TEST(Flip, BadInput) {
  EXPECT_THROW(flip(rgb_image(2, 2, 0, 0, 0), rgb_image(3, 2, 0, 0, 0)), Error);
  EXPECT_THROW(flip(Image(2, 2, {"Y"}), Image(2, 2, {"Y"})), Error);
  EXPECT_THROW(flip(rgb_image(2, 2, 0, 0, 0), rgb_image(2, 2, 0, 0, 0), 0), Error);
  EXPECT_TRUE(std::isnan(flip(rgb_image(2, 2, std::nanf(""), 0, 0), rgb_image(2, 2, 0, 0, 0))));
}

// Errors now: .25, -.5, 0, 1; before, at the pixels' points: pixel 2's for 0, none for 1, its own for 2
// and 3.
TEST(Flicker, IsTheChangeOfTheErrorWhereAPointIsSeenTwice) {
  const std::vector<float> result = {0.75f, 0.5f, 1, 1}, reference = {0.5f, 1, 1, 0};
  const std::vector<float> result_before = {0, 0, 1, 0.5f}, reference_before = {0, 0, 0.5f, 0};
  std::vector<uint8_t> domain = {0, 0, 0, 0};
  const std::vector<uint8_t> all = domain;
  const std::vector<uint32_t> before = {2, kNotSeenBefore, 2, 3};
  const auto value = [&] {
    return flicker({result, reference, domain}, {result_before, reference_before, all}, before);
  };
  EXPECT_DOUBLE_EQ(*value(), (0.25 + 0.5 + 0.5) / 3);
  domain[3] = 1;  // not counted now
  EXPECT_DOUBLE_EQ(*value(), (0.25 + 0.5) / 2);
  const std::vector<uint8_t> but_2 = {0, 0, 3, 0};  // not counted before
  EXPECT_FALSE(flicker({result, reference, domain}, {result_before, reference_before, but_2}, before));
  const std::vector<float> broken = {NAN, 0, 0, 0};
  EXPECT_TRUE(std::isnan(*flicker({broken, reference, all}, {result_before, reference_before, all}, before)));
  EXPECT_THROW(flicker({result, reference, domain}, {result_before, reference_before, {}}, before), Error);
}

TEST(MetricInfos, AreNamedOnceAndComplete) {
  std::set<std::string> names;
  for (const MetricInfo& info : metric_infos()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_FALSE(info.definition.empty() || info.unit.empty() || info.source.empty()) << info.name;
  }
  for (const char* name : {"rmse", "mae", "max", "bias", "misclassified", "wrongly_lit", "wrongly_shadowed",
                           "penumbra_rmse", "umbra_light", "leak", "over_shadow", "acne", "ssim", "flip",
                           "flicker", "pixels", "excluded", "nonfinite"})
    EXPECT_TRUE(names.contains(name)) << name;
}

}  // namespace
}  // namespace gnomon
