// How much of a light is above a receiver's horizon, against points counted one by one.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon::test {
namespace {

// x, y: the horizon's slope; z: its height.
std::vector<glm::vec4> horizons() {
  std::vector<glm::vec4> all{{0, 0, 1, 0},     {0, 0, -1, 0},     {1, 0, 0, 0},
                             {0, -2, 0, 0},    {1, 1, 0, 0},      {1, 1e-6f, 0.5, 0},
                             {1, -1, 1.9f, 0}, {-1, 1, -1.9f, 0}, {1, 1e-3f, 1, 0}};
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < 60; ++i) all.emplace_back(uniform(engine), uniform(engine), 1.5f * uniform(engine), 0);
  return all;
}

// Over the middles of a fine grid: the share of the square and of the disc.
std::array<double, 2> counted(const glm::dvec3& h) {
  constexpr int kSide = 1000;
  std::array<double, 2> above{}, all{};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const glm::dvec2 p((2 * x + 1.0) / kSide - 1, (2 * y + 1.0) / kSide - 1);
      const bool in_disc = glm::dot(p, p) <= 1, is_above = h.x * p.x + h.y * p.y + h.z > 0;
      all[0] += 1, all[1] += in_disc;
      above[0] += is_above, above[1] += is_above && in_disc;
    }
  return {above[0] / all[0], above[1] / all[1]};
}

TEST(GpuLightHorizon, SharesOfSquareAndDiscAreThoseOfTheirPoints) {
  const Kernel kernel("light_horizon", R"(
#include "lib/light_horizon.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Jobs { vec4 jobs[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Answers { vec2 answers[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= jobs.length()) return;
  Horizon h = Horizon(jobs[i].xy, jobs[i].z);
  answers[i] = vec2(square_above(h), disc_above(h));
}
)",
                      2);
  const auto all = horizons();
  const auto is = kernel.run<glm::vec2>({bytes_of(all)}, all.size());
  for (size_t i = 0; i < all.size(); ++i) {
    const auto wanted = counted(glm::dvec3(all[i]));
    // A line meets at most twice the grid's side in cells, each of which it may count wrongly by half.
    EXPECT_NEAR(is[i].x, wanted[0], 1.5e-3) << i;
    EXPECT_NEAR(is[i].y, wanted[1], 1.5e-3) << i;
  }
}

}  // namespace
}  // namespace gnomon::test
