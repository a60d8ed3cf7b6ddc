// Every level of min-max pyramids against brute force over the map.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <random>
#include <string>

#include "tests/passes/texel_passes.h"
#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon {
namespace {

using test::Pick;

struct Case {
  uint32_t width, height;
  int layers;
};

class MinMaxPyramid : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, MinMaxPyramid,
                         testing::Values(Case{1, 1, 1}, Case{1, 13, 2}, Case{29, 1, 1}, Case{2, 2, 3},
                                         Case{3, 3, 1}, Case{64, 64, 1}, Case{65, 63, 2}, Case{37, 90, 6},
                                         Case{5, 128, 1}),
                         [](const auto& info) {
                           return std::to_string(info.param.width) + "x" + std::to_string(info.param.height) +
                                  "x" + std::to_string(info.param.layers);
                         });

void give_random(const Case& c) {
  std::mt19937 random(c.width * 1000 + c.height);
  std::uniform_real_distribution<float> uniform(0, 1);
  auto& texels = test::given_texels();
  texels.resize(size_t(c.width) * c.height * size_t(c.layers));
  for (float& t : texels) t = uniform(random);
}

uint32_t word_of(float value) { return std::bit_cast<uint32_t>(value); }

// The block of a level that a texel is in, as lib/min_max.glsl documents it.
uint32_t block(uint32_t texel, int level, uint32_t blocks) {
  return std::min(texel >> (level + 1), blocks - 1);
}

TEST_P(MinMaxPyramid, HoldsEveryTexelOfTheMapInEveryLevel) {
  const Case c = GetParam();
  give_random(c);
  Extent level_size{(c.width + 1) / 2, (c.height + 1) / 2};
  const int levels = std::bit_width(std::max(level_size.width, level_size.height));
  std::vector<Pick> picks;
  for (int layer = 0; layer < c.layers; ++layer)
    for (int level = 0; level < levels; ++level)
      for (const int channel : {0, 1}) picks.push_back({layer, level, channel});
  const auto words = test::picked(
      {c.width, c.height}, c.layers, 1,
      R"(, { "id": "pyramid", "type": "min_max_pyramid", "in": { "shadow_map": "texels.texels" } })",
      "pyramid.pyramid", picks);
  for (size_t i = 0; i < picks.size(); ++i) {
    const Pick& p = picks[i];
    if (p.level == 0) level_size = {(c.width + 1) / 2, (c.height + 1) / 2};
    const bool least = p.channel == 0;
    std::vector<float> wanted(size_t(level_size.width) * level_size.height, least ? 2.0f : -1.0f);
    for (uint32_t y = 0; y < c.height; ++y)
      for (uint32_t x = 0; x < c.width; ++x) {
        const float t = test::given_texels()[(size_t(p.layer) * c.height + y) * c.width + x];
        float& w = wanted[size_t(block(y, p.level, level_size.height)) * level_size.width +
                          block(x, p.level, level_size.width)];
        w = least ? std::min(w, t) : std::max(w, t);
      }
    for (uint32_t y = 0; y < level_size.height; ++y)
      for (uint32_t x = 0; x < level_size.width; ++x)
        ASSERT_EQ(words[i][size_t(y) * c.width + x], word_of(wanted[size_t(y) * level_size.width + x]))
            << "layer " << p.layer << ", level " << p.level << ", " << x << ' ' << y;
    if (p.channel == 1)
      level_size = {std::max(level_size.width / 2, 1u), std::max(level_size.height / 2, 1u)};
  }
}

// Windows of every width at every place: two blocks on an axis hold them, and one level finer would not
// always do.
TEST(MinMaxPyramidLevel, IsTheFinestOfWhichTwoBlocksHoldAWindow) {
  const test::Kernel kernel("pyramid_level", R"(
#include "lib/min_max.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Jobs { ivec4 jobs[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Answers { ivec4 answers[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= jobs.length()) return;
  ivec4 job = jobs[i];
  int level = pyramid_level(job.y);
  ivec2 first = pyramid_block(ivec2(job.x), level, ivec2(job.z)), last = pyramid_block(ivec2(job.x + job.y - 1), level, ivec2(job.z));
  answers[i] = ivec4(level, first.x, last.x, 0);
}
)",
                            2);
  struct Words {
    int x, y, z, w;
  };
  std::vector<Words> jobs;
  for (int width = 1; width <= 70; ++width)
    for (int at = 0; at < 140; ++at) jobs.push_back({at, width, 1 << 20, 0});
  const auto is = kernel.run<Words>({test::bytes_of(jobs)}, jobs.size());
  std::vector<int> widest(71, 0);
  for (size_t i = 0; i < jobs.size(); ++i) {
    const auto [at, width, blocks, unused] = jobs[i];
    const int size = 2 << is[i].x;
    EXPECT_EQ(is[i].y, at / size);
    EXPECT_EQ(is[i].z, (at + width - 1) / size);
    EXPECT_LE(is[i].z - is[i].y, 1) << width;
    const int finer = size / 2;
    widest[size_t(width)] = std::max(widest[size_t(width)], (at + width - 1) / finer - at / finer);
  }
  for (int width = 4; width <= 70; ++width) EXPECT_GT(widest[size_t(width)], 1) << width;
}

}  // namespace
}  // namespace gnomon
