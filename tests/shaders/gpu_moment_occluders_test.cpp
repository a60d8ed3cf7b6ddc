// What averages of a shadow map tell of what hides the light, against distributions of depth that are known.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <random>

#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon::test {
namespace {

// Shares of depths in [0, 1]; the last one is the receiver's.
struct Depths {
  std::array<double, 3> share, depth;
  double receiver() const { return depth[2]; }
  double mean(const std::function<double(double)>& f) const {
    double sum = 0;
    for (size_t i = 0; i < 3; ++i) sum += share[i] * f(depth[i]);
    return sum;
  }
  double hidden() const { return share[0] + share[1]; }
  double hidden_depth() const { return share[0] * depth[0] + share[1] * depth[1]; }
};

// `one`: both occluders at one depth.
std::vector<Depths> random_depths(bool one) {
  std::mt19937 engine(9);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine);
  };
  std::vector<Depths> all;
  for (int i = 0; i < 200; ++i) {
    const double t = uniform(0.5, 1), near = uniform(0.05, 0.35),
                 far = one ? near : uniform(near + 0.05, t - 0.05);
    const double hidden = uniform(0.1, 0.9), first = hidden * uniform(0.2, 0.8);
    all.push_back({{first, hidden - first, 1 - hidden}, {near, far, t}});
  }
  return all;
}

struct Job {
  glm::vec4 means, receiver;  // receiver.x: its depth; y: more, as a test wants it
};

// x: hidden share; y: the share times its mean depth. `body` maps means m and receiver r to a vec2.
std::vector<glm::vec2> run(const std::string& name, const std::string& body, const std::vector<Job>& jobs) {
  const Kernel kernel("occluders_" + name, R"(
#include "lib/moment_warp.glsl"
#include "lib/variance_shadow.glsl"
#include "lib/moment_shadow.glsl"
#include "lib/moment_occluders.glsl"
layout(local_size_x = 64) in;
struct Job { vec4 means, receiver; };
layout(set = 0, binding = 0, std430) readonly buffer Jobs { Job jobs[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Answers { vec2 answers[]; };
vec2 answer(vec4 m, vec4 r) { )" + body + R"( }
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < jobs.length()) answers[i] = answer(jobs[i].means, jobs[i].receiver);
}
)",
                      2);
  return kernel.run<glm::vec2>({bytes_of(jobs)}, jobs.size());
}

// Chebyshev's inequality is an equality where all that hides the light is at one depth.
TEST(GpuMomentOccluders, VarianceKnowsOneDepthBeforeAReceiver) {
  const auto all = random_depths(true);
  std::vector<Job> jobs;
  for (const Depths& d : all) {
    const double mean = d.mean([](double z) { return z - 0.5; });
    const double square = d.mean([](double z) { return (z - 0.5) * (z - 0.5); });
    jobs.push_back({{mean, square, 0, 0}, {d.receiver(), 0, 0, 0}});
  }
  const auto is = run("variance", "return variance_occluders(m.xy, r.x, 1e-9);", jobs);
  for (size_t i = 0; i < all.size(); ++i) {
    EXPECT_NEAR(is[i].x, all[i].hidden(), 1e-4) << i;
    EXPECT_NEAR(is[i].y, all[i].hidden_depth(), 1e-4) << i;
  }
}

// Four moments tell two depths from the receiver's.
TEST(GpuMomentOccluders, FourMomentsKnowTwoDepthsBeforeAReceiver) {
  const auto all = random_depths(false);
  std::vector<Job> jobs;
  for (const Depths& d : all) {
    glm::vec4 m;
    for (int k = 0; k < 4; ++k) m[k] = float(d.mean([k](double z) { return std::pow(2 * z - 1, k + 1); }));
    jobs.push_back({m, {d.receiver(), 0, 0, 0}});
  }
  const auto is = run("four_moments", "return four_moment_occluders(m, r.x);", jobs);
  for (size_t i = 0; i < all.size(); ++i) {
    EXPECT_NEAR(is[i].x, all[i].hidden(), 0.01) << i;
    EXPECT_NEAR(is[i].y, all[i].hidden_depth(), 0.01) << i;
  }
}

TEST(GpuMomentOccluders, ExponentialWeighsByTheComplementOfItsTest) {
  constexpr double kExponent = 16;
  const auto all = random_depths(false);
  std::vector<Job> jobs;
  for (const Depths& d : all) {
    const auto power = [](double z) { return std::exp(kExponent * (z - 1)); };
    const double e = d.mean(power), ze = d.mean([&](double z) { return z * power(z); });
    jobs.push_back(
        {{e, ze, d.mean([](double z) { return z; }), 0}, {d.receiver(), power(d.receiver()), 0, 0}});
  }
  const auto is = run("exponential", "return exponential_occluders(m.xyz, r.x, r.y);", jobs);
  for (size_t i = 0; i < all.size(); ++i) {
    const double t = all[i].receiver();
    const auto hides = [&](double z) { return 1 - std::exp(-kExponent * (t - z)); };
    EXPECT_NEAR(is[i].x, all[i].mean(hides), 1e-5) << i;
    EXPECT_NEAR(is[i].y, all[i].mean([&](double z) { return z * hides(z); }), 1e-5) << i;
  }
}

TEST(GpuMomentOccluders, AReceiverThatNothingIsNearerThanHasNone) {
  const std::vector<Job> jobs{{{0.3f, 0.09f, 0, 0}, {0.8f, 0, 0, 0}}, {{0.3f, 0.09f, 0, 0}, {0.2f, 0, 0, 0}}};
  for (const glm::vec2& none : run("none", "return variance_occluders(m.xy, r.x, 1e-9);", jobs))
    EXPECT_EQ(none, glm::vec2(0));
}

// Over a plane that rises by 2 r: the mean of e^(c x) there.
TEST(GpuMomentOccluders, ExponentialsOfAPlaneHaveAClosedMean) {
  std::vector<Job> jobs;
  for (const double reach : {0.0, 1e-3, 0.02, 0.5, 3.0, 10.0}) jobs.push_back({{reach, 0, 0, 0}, {}});
  const auto is = run("plane", "return vec2(mean_of_exponential(m.x), mean_of_exponential(-m.x));", jobs);
  for (size_t i = 0; i < jobs.size(); ++i) {
    const double reach = jobs[i].means.x, wanted = reach == 0 ? 1 : std::sinh(reach) / reach;
    EXPECT_NEAR(is[i].x, wanted, 1e-5 * wanted);
    EXPECT_EQ(is[i].x, is[i].y);
  }
}

}  // namespace
}  // namespace gnomon::test
