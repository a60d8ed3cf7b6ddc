// Which samples a sequence of answers selects.
#include "passes/area/light_quads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "engine/base/error.h"

namespace gnomon {
namespace {

using Decide = std::function<bool(const LightQuads::Quad&)>;

// Answers until there are no questions; the number of iterations.
uint32_t run(LightQuads& quads, const Decide& divide) {
  uint32_t iterations = 0;
  while (!quads.questions().empty()) {
    std::vector<bool> answers;
    for (const LightQuads::Quad& quad : quads.questions()) answers.push_back(divide(quad));
    quads.answer(answers);
    ++iterations;
  }
  return iterations;
}

bool always(const LightQuads::Quad&) { return true; }
bool never(const LightQuads::Quad&) { return false; }

std::set<std::pair<double, double>> places(const LightQuads& quads) {
  std::set<std::pair<double, double>> result;
  for (const glm::dvec2& p : quads.samples()) result.insert({p.x, p.y});
  return result;
}

// A decision that depends on the quad alone, and differs from quad to quad.
Decide scattered(uint32_t seed) {
  return [seed](const LightQuads::Quad& quad) {
    std::mt19937 random(seed ^ (quad.level * 7919u + quad.corner.x * 104729u + quad.corner.y * 1299709u));
    return random() % 5 != 0;
  };
}

TEST(LightQuads, BeginsWithTheCornersAndOneQuestion) {
  const LightQuads quads(4, QuadOrder::breadth_first);
  ASSERT_EQ(quads.questions().size(), 1u);
  EXPECT_EQ(quads.samples(), (std::vector<glm::dvec2>{{0, 0}, {1, 0}, {0, 1}, {1, 1}}));
}

TEST(LightQuads, NoBandingEndsAtLevelZero) {
  LightQuads quads(4, QuadOrder::breadth_first);
  EXPECT_EQ(run(quads, never), 1u);
  EXPECT_EQ(quads.samples().size(), 4u);
  EXPECT_EQ(quads.weights(SampleWeights::area), (std::vector<double>{0.25, 0.25, 0.25, 0.25}));
}

TEST(LightQuads, BandingEverywhereSelectsTheWholeGridLevelByLevel) {
  for (const uint32_t levels : {0u, 1u, 2u, 3u, 4u, 5u}) {
    LightQuads quads(levels, QuadOrder::breadth_first);
    EXPECT_EQ(run(quads, always), levels) << "one turn a level";
    const size_t side = (size_t{1} << levels) + 1;
    EXPECT_EQ(quads.samples().size(), side * side);
    EXPECT_EQ(places(quads).size(), side * side) << "samples shared by neighbours are made once";
    EXPECT_EQ(quads.leaves().size(), size_t{1} << (2 * levels));
  }
}

TEST(LightQuads, DividingOneQuadAddsFiveSamplesWhoseNeighboursShareThem) {
  LightQuads quads(4, QuadOrder::breadth_first);
  quads.answer({true});
  EXPECT_EQ(quads.samples().size(), 9u);
  EXPECT_EQ(quads.first_new(), 4u);
  ASSERT_EQ(quads.questions().size(), 4u);
  quads.answer({true, true, false, false});  // the two lower quads share an edge: 5 + 5 - 1 samples
  EXPECT_EQ(quads.samples().size(), 18u);
  EXPECT_EQ(quads.first_new(), 9u);
  EXPECT_EQ(quads.questions().size(), 8u);
}

TEST(LightQuads, BothOrdersSelectTheSameSamples) {
  for (uint32_t seed = 0; seed < 50; ++seed) {
    LightQuads breadth(4, QuadOrder::breadth_first), depth(4, QuadOrder::depth_first);
    const uint32_t levels = run(breadth, scattered(seed)), quads = run(depth, scattered(seed));
    EXPECT_LE(levels, 4u);
    EXPECT_GE(quads, levels);
    EXPECT_EQ(places(breadth), places(depth)) << "seed " << seed;
    EXPECT_EQ(breadth.leaves().size(), depth.leaves().size());
  }
}

TEST(LightQuads, DepthFirstAsksOneQuadATime) {
  LightQuads quads(3, QuadOrder::depth_first);
  while (!quads.questions().empty()) {
    EXPECT_EQ(quads.questions().size(), 1u);
    quads.answer({true});
  }
  EXPECT_EQ(quads.samples().size(), 81u);
}

// The weights' sums are 1, and over linear functions of the light the area weights are exact: the trapezoid
// rule.
TEST(LightQuads, AreaWeightsIntegrateLinearFunctionsExactly) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    LightQuads quads(4, QuadOrder::breadth_first);
    run(quads, scattered(seed));
    for (const SampleWeights kind : {SampleWeights::area, SampleWeights::leaf, SampleWeights::creation}) {
      const std::vector<double> w = quads.weights(kind);
      ASSERT_EQ(w.size(), quads.samples().size());
      EXPECT_NEAR(std::accumulate(w.begin(), w.end(), 0.0), 1.0, 1e-12);
      EXPECT_GT(*std::min_element(w.begin(), w.end()), 0.0);
    }
    const std::vector<double> w = quads.weights(SampleWeights::area);
    double integral = 0;
    for (size_t i = 0; i < w.size(); ++i)
      integral += w[i] * (0.3 + 2.0 * quads.samples()[i].x - 0.7 * quads.samples()[i].y);
    EXPECT_NEAR(integral, 0.3 + 1.0 - 0.35, 1e-12);
  }
}

// (6.5): 1 / (2^level + 1)^2 before the sum is made 1.
TEST(LightQuads, WeightsByLevelAreThePapers) {
  LightQuads quads(2, QuadOrder::breadth_first);
  quads.answer({true});
  quads.answer({true, false, false, false});
  const std::vector<double> made = quads.weights(SampleWeights::creation),
                            leaf = quads.weights(SampleWeights::leaf);
  EXPECT_NEAR(made[0] / made[4], (1.0 / 4) / (1.0 / 9),
              1e-12);  // a corner of the light, and a sample of level 1
  EXPECT_NEAR(leaf[0] / leaf[3], (1.0 / 25) / (1.0 / 9),
              1e-12);  // the corner that was divided, and the one across
}

LightSurface disc() {
  const auto holds = [](glm::dvec2 u) { return glm::length(u - 0.5) <= 0.5 + 1e-9; };
  return {holds, [=](glm::dvec2 min, glm::dvec2 max) {
            int on = 0;
            for (int y = 0; y < 16; ++y)
              for (int x = 0; x < 16; ++x) on += holds(glm::mix(min, max, (glm::dvec2(x, y) + 0.5) / 16.0));
            return on / 256.0 * (max.x - min.x) * (max.y - min.y);
          }};
}

TEST(LightQuads, OnADiscOnlyPlacesOnItAreSampled) {
  LightQuads quads(4, QuadOrder::breadth_first, disc());
  EXPECT_EQ(quads.samples().size(), 5u)
      << "the square's corners are off the disc: it is divided without a question";
  EXPECT_EQ(quads.questions().size(), 4u);
  run(quads, always);
  for (const glm::dvec2& p : quads.samples()) EXPECT_LE(glm::length(p - 0.5), 0.5 + 1e-9);
  const std::vector<double> w = quads.weights(SampleWeights::area);
  EXPECT_NEAR(std::accumulate(w.begin(), w.end(), 0.0), 1.0, 1e-12);
  double left = 0, bottom = 0;
  for (size_t i = 0; i < w.size(); ++i) {
    left += w[i] * (quads.samples()[i].x - 0.5);
    bottom += w[i] * (quads.samples()[i].y - 0.5);
  }
  EXPECT_NEAR(left, 0, 1e-9) << "symmetric";
  EXPECT_NEAR(bottom, 0, 1e-9);
}

TEST(LightQuads, ALightThatNoGridPointHitsHasNoSamples) {
  LightQuads quads(2, QuadOrder::breadth_first,
                   {[](glm::dvec2) { return false; }, [](glm::dvec2, glm::dvec2) { return 0.1; }});
  EXPECT_TRUE(quads.questions().empty());
  EXPECT_TRUE(quads.samples().empty());
}

TEST(LightQuads, AQueryThatIsNotAnsweredIsAnError) {
  EXPECT_EQ(any_passed(std::vector<uint32_t>{7, 1, 0, 1}), (std::vector<bool>{true, false}));
  EXPECT_THROW(any_passed(std::vector<uint32_t>{7, 1, 0, 0}), Error);
}

}  // namespace
}  // namespace gnomon
