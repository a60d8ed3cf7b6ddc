// Summed-area tables against sums of 64 bits, and rectangles read from them against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <string>

#include "tests/passes/texel_passes.h"
#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon {
namespace {

using test::Pick;

struct Case {
  uint32_t width, height;
  int layers, channels, largest_kernel;
};

class SummedAreaTable : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, SummedAreaTable,
                         testing::Values(Case{1, 1, 1, 1, 2}, Case{1, 70, 1, 2, 64}, Case{33, 1, 2, 4, 9},
                                         Case{64, 64, 1, 1, 2}, Case{65, 43, 3, 4, 63},
                                         Case{131, 17, 1, 2, 255}),
                         [](const auto& info) {
                           return std::to_string(info.param.width) + "x" + std::to_string(info.param.height) +
                                  "x" + std::to_string(info.param.layers) + "_channels_" +
                                  std::to_string(info.param.channels);
                         });

void give_random(const Case& c, float least, float most) {
  std::mt19937 random(c.width * 1000 + c.height);
  std::uniform_real_distribution<float> uniform(least, most);
  auto& texels = test::given_texels();
  texels.resize(size_t(c.width) * c.height * size_t(c.layers) * size_t(c.channels));
  for (float& t : texels) t = uniform(random);
}

float texel(const Case& c, const Pick& p, uint32_t x, uint32_t y) {
  return test::given_texels()[((size_t(p.layer) * c.height + y) * c.width + x) * size_t(c.channels) +
                              size_t(p.channel)];
}

std::vector<Pick> all_of(const Case& c) {
  std::vector<Pick> picks;
  for (int layer = 0; layer < c.layers; ++layer)
    for (int channel = 0; channel < c.channels; ++channel) picks.push_back({layer, 0, channel});
  return picks;
}

std::vector<std::vector<uint32_t>> table(const Case& c, const std::string& params) {
  return test::picked(
      {c.width, c.height}, c.layers, c.channels,
      R"(, { "id": "table", "type": "summed_area_table", "in": { "source": "texels.texels" }, "params": { )" +
          params + " } }",
      "table.sums", all_of(c));
}

TEST_P(SummedAreaTable, IntegersAreTheWholeSumsModulo2To32) {
  const Case c = GetParam();
  give_random(c, -0.1f, 1.1f);  // beyond the range, which ends at 0 and 1
  const auto words = table(c, "\"largest_kernel\": " + std::to_string(c.largest_kernel));
  const uint64_t scale = 0xFFFFFFFFu / (uint64_t(c.largest_kernel) * uint64_t(c.largest_kernel));
  const auto factor = float(double(scale));
  const auto picks = all_of(c);
  for (size_t i = 0; i < picks.size(); ++i) {
    std::vector<uint64_t> above(c.width, 0);
    for (uint32_t y = 0; y < c.height; ++y) {
      uint64_t row = 0;
      for (uint32_t x = 0; x < c.width; ++x) {
        const float steps = std::max(texel(c, picks[i], x, y) * factor, 0.0f) + 0.5f;
        row += std::min<uint64_t>(uint64_t(steps), scale);
        above[x] += row;
        ASSERT_EQ(words[i][size_t(y) * c.width + x], uint32_t(above[x])) << x << ' ' << y;
      }
    }
  }
}

// Ranges other than [0, 1]: as many steps as the range has.
TEST(SummedAreaTableRange, MapsItsEndsToNothingAndToAllSteps) {
  const Case c{2, 1, 1, 1, 16};
  test::given_texels() = {-1.0f, 3.0f};
  const auto words = table(c, R"("largest_kernel": 16, "least": -1, "greatest": 3)");
  EXPECT_EQ(words[0][0], 0u);
  EXPECT_EQ(words[0][1], 0xFFFFFFFFu / 256u);
}

// Values of many magnitudes: the second of two integers has what the first, of whole steps, leaves.
TEST(SummedAreaTablePairs, KeepWhatIsLessThanAStep) {
  const Case c{4, 1, 1, 2, 128};
  test::given_texels() = {1e-9f, 1.0f, 3e-7f, 0.25f, 0.75f, 1e-8f, 1e-5f, 0.0f};
  const std::vector<Pick> picks{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}};
  const auto words = test::picked(
      {c.width, c.height}, c.layers, c.channels,
      R"(, { "id": "table", "type": "summed_area_table", "in": { "source": "texels.texels" }, "params": { "numbers": "integer_pair" } })",
      "table.sums", picks);
  const double steps = 0xFFFFFFFFu / (128u * 128u);
  for (size_t channel = 0; channel < 2; ++channel) {
    double sum = 0;
    for (uint32_t x = 0; x < c.width; ++x) {
      const double value = test::given_texels()[2 * x + channel];
      sum += value;
      const double is = (words[channel][x] + words[channel + 2][x] / steps) / steps;
      // A step of the second integer for each texel, and a float's rounding of the largest.
      EXPECT_NEAR(is, sum, (x + 1) / (steps * steps) + 1e-7 * sum) << x;
    }
  }
}

TEST_P(SummedAreaTable, FloatsAreTheSumsUpToRounding) {
  const Case c = GetParam();
  give_random(c, 0, 1);
  const auto words = table(c, R"("numbers": "float")");
  const auto picks = all_of(c);
  for (size_t i = 0; i < picks.size(); ++i) {
    std::vector<double> above(c.width, 0);
    for (uint32_t y = 0; y < c.height; ++y) {
      double row = 0;
      for (uint32_t x = 0; x < c.width; ++x) {
        row += texel(c, picks[i], x, y);
        above[x] += row;
        // Each of at most width + height additions rounds by half an ulp of at most the sum.
        ASSERT_NEAR(std::bit_cast<float>(words[i][size_t(y) * c.width + x]), above[x],
                    6e-8 * (c.width + c.height) * above[x]);
      }
    }
  }
}

// ------------------------------------------------------------------------------------------- rectangles

constexpr int kWidth = 23, kHeight = 17;  // of the table below

// Steps of a table that wraps: 41 texels of the top value fill the range of 32 bits.
std::vector<uint32_t> random_steps() {
  std::mt19937 random(5);
  std::uniform_int_distribution<uint32_t> uniform(0, 100000000u);
  std::vector<uint32_t> steps(kWidth * kHeight);
  for (uint32_t& s : steps) s = uniform(random);
  return steps;
}

std::vector<uint32_t> summed(const std::vector<uint32_t>& steps) {
  std::vector<uint32_t> sums(steps.size());
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto at = [&](int i, int j) { return i < 0 || j < 0 ? 0u : sums[size_t(j * kWidth + i)]; };
      sums[size_t(y * kWidth + x)] =
          steps[size_t(y * kWidth + x)] + at(x - 1, y) + at(x, y - 1) - at(x - 1, y - 1);
    }
  return sums;
}

double covered(int texel, double begin, double end) {
  return std::max(0.0, std::min(texel + 1.0, end) - std::max(double(texel), begin));
}

double brute_force(const std::vector<uint32_t>& steps, const float (&r)[4]) {
  double sum = 0;
  for (int y = int(std::floor(r[1])); y < int(std::ceil(r[3])); ++y)
    for (int x = int(std::floor(r[0])); x < int(std::ceil(r[2])); ++x)
      sum += covered(x, r[0], r[2]) * covered(y, r[1], r[3]) *
             steps[size_t(std::clamp(y, 0, kHeight - 1) * kWidth + std::clamp(x, 0, kWidth - 1))];
  return sum;
}

struct Rectangle {
  float r[4];  // low x, low y, high x, high y
};

std::vector<Rectangle> rectangles() {
  std::mt19937 random(7);
  const auto uniform = [&](double a, double b) {
    return float(std::uniform_real_distribution<double>(a, b)(random));
  };
  // Of one texel and less, of whole texels, of all, at and beyond each border.
  std::vector<Rectangle> all{{{3.25f, 4.5f, 3.75f, 4.75f}},
                             {{3, 4, 4, 5}},
                             {{2, 3, 8, 9}},
                             {{3.5f, 4.5f, 4.5f, 5.5f}},
                             {{0, 0, 5, 5}},
                             {{18, 12, kWidth, kHeight}},
                             {{-3, -2.5f, 1.5f, 2}},
                             {{21.5f, 15, 27, 20}},
                             {{-5, -5, -2, -1}},
                             {{25, 20, 27, 23}},
                             {{-4, 3, -1.5f, 6.25f}},
                             {{22.25f, 16.5f, 22.5f, 18}}};
  for (int i = 0; i < 500; ++i) {
    const float x = uniform(-6, kWidth + 3), y = uniform(-6, kHeight + 3);
    all.push_back({{x, y, x + uniform(0, 6), y + uniform(0, 6)}});  // 36 texels at most
  }
  return all;
}

std::vector<float> rectangle_sums(const std::vector<uint32_t>& sums, const std::string& type) {
  const test::Kernel kernel("summed_rectangle_" + type, R"(
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Table { uint table[]; };
layout(set = 0, binding = 1, std430) readonly buffer Jobs { vec4 jobs[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Answers { float answers[]; };
#define SUMMED )" + type + R"(
const ivec2 SIZE = ivec2(23, 17);
SUMMED summed_at(ivec2 texel, int layer) { return SUMMED(table[texel.y * SIZE.x + texel.x]); }
#include "lib/summed_area.glsl"
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < jobs.length()) answers[i] = summed_rectangle(jobs[i].xy, jobs[i].zw, SIZE, 0).x;
}
)",
                            3);
  const auto jobs = rectangles();
  return kernel.run<float>({test::bytes_of(sums), test::bytes_of(jobs)}, jobs.size());
}

TEST(GpuSummedArea, RectanglesWithFractionalCornersAreTheCoveredTexels) {
  const auto steps = random_steps();
  const auto is = rectangle_sums(summed(steps), "uvec4");
  const auto jobs = rectangles();
  for (size_t i = 0; i < jobs.size(); ++i) {
    const double wanted = brute_force(steps, jobs[i].r);
    // Weights round with the corners' place, pieces with their own size.
    EXPECT_NEAR(is[i], wanted, 1e-6 * wanted + 1e8 * 8e-6) << i;
  }
}

TEST(GpuSummedArea, FloatTablesAreReadAlike) {
  auto steps = random_steps();
  for (uint32_t& s : steps) s %= 64;  // their sums are exact floats
  const auto is = rectangle_sums(summed(steps), "vec4");
  const auto jobs = rectangles();
  for (size_t i = 0; i < jobs.size(); ++i) EXPECT_NEAR(is[i], brute_force(steps, jobs[i].r), 1e-2) << i;
}

}  // namespace
}  // namespace gnomon
