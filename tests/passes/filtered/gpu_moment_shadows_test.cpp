// The pre-filtered techniques end to end: against shadow mapping, over their
// parameters' ranges, and past them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tests/engine/truth/analytic_scenes.h"
#include "tests/parameter_name.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using analytic::light;
using hard_shadow::device;

RenderSettings small() { return hard_shadow::settings(true, 96, 72); }

std::vector<std::vector<float>> visibility(const std::string& graph, const Scene& scene, const Values& set,
                                           const RenderSettings& s = small()) {
  return hard_shadow::visibility(graph, scene, s, set);
}

void expect_in_range(const std::string& graph, const Scene& scene, const Values& set) {
  for (const auto& plane : visibility(graph, scene, set))
    for (const float v : plane) {
      if (std::isfinite(v) && v >= 0 && v <= 1) continue;
      std::string text = graph;
      for (const auto& [name, value] : set) text += ", " + name + " " + to_string(value);
      FAIL() << text << ": " << v;
    }
}

Scene floor_and_square(LightType type) { return analytic::square_over_plane(light(type, {1.5, 7, 1})); }
const char* const kGraphs[] = {"vsm", "esm", "evsm", "msm", "csm", "gsm"};

// Settings that test variants: what the graph's defaults leave out.
const std::vector<std::pair<std::string, Values>>& variants() {
  static const std::vector<std::pair<std::string, Values>> all = {
      {"vsm", {}},
      {"vsm", {{"precision", "half"}}},
      {"vsm", {{"shape", "gaussian"}, {"mip_maps", true}}},
      {"esm", {{"exponent", 88.7}}},
      {"esm", {{"exponent", 11.08}, {"precision", "half"}}},
      {"esm", {{"exponent", 10000.0}, {"space", "log"}}},
      {"esm", {{"exponent", 1.0}, {"space", "log"}, {"precision", "half"}}},
      {"evsm", {{"exponent", 42.0}, {"negative_exponent", 42.0}}},
      {"evsm", {{"exponent", 5.54}, {"negative_exponent", 5.54}, {"precision", "half"}}},
      {"evsm", {{"basis", "exponential_variance"}, {"exponent", 42.0}}},
      {"msm", {}},
      {"msm", {{"solver", "hausdorff"}}},
      {"msm", {{"precision", "half"}}},
      {"msm", {{"precision", "half"}, {"solver", "hausdorff"}}},
      {"msm", {{"moment_bias", 0.0}}},
      {"msm", {{"moment_bias", 0.0}, {"solver", "hausdorff"}, {"mip_maps", true}}},
      {"csm", {{"terms", int64_t(1)}}},
      {"csm", {{"terms", int64_t(7)}, {"precision", "half"}, {"ringing", 1.0}}},
      {"gsm", {}},
      {"gsm", {{"basis", "exponential_variance"}, {"exponent", 42.0}, {"bound", "gaussian_cdf"}}}};
  return all;
}

Values with(Values set, const Values& more) {
  for (const auto& [name, value] : more) set[name] = value;
  return set;
}

// ---------------------------------------------------------------------------------
// against shadow mapping

struct LitGraph {
  const char* graph;
  LightType type;
};
void PrintTo(const LitGraph& c, std::ostream* out) { *out << c.graph << ' ' << analytic::name_of(c.type); }
std::vector<LitGraph> lit_graphs() {
  std::vector<LitGraph> all;
  for (const char* graph : kGraphs)
    for (const LightType type : {LightType::spot, LightType::directional, LightType::point})
      all.push_back({graph, type});
  return all;
}
class EveryLight : public testing::TestWithParam<LitGraph> {};
INSTANTIATE_TEST_SUITE_P(All, EveryLight, testing::ValuesIn(lit_graphs()), test::ParameterName());

// With a kernel of one texel only the bilinear reading filters: away from edges
// (here: where the 7x7 pixels around agree) a pixel is what shadow mapping
// says. The Fourier series has the ringing of its terms.
TEST_P(EveryLight, OneTexelIsShadowMappingAwayFromEdges) {
  const auto [graph, type] = GetParam();
  const Scene scene = floor_and_square(type);
  const RenderSettings s = hard_shadow::settings(true);
  Values set = {{"shadow_map", int64_t(512)}, {"kernel", int64_t(1)}};
  const auto hard = visibility("shadow_mapping", scene, {{"shadow_map", int64_t(512)}}, s)[0];
  if (std::string(graph) == "csm") set["terms"] = int64_t(16);
  const auto soft = visibility(graph, scene, set, s)[0];
  const double tolerance = std::string(graph) == "csm" ? 0.2 : 0.02;
  const int width = int(s.width), height = int(s.height), reach = 3;
  size_t lit = 0, shadowed = 0, wrong = 0;
  for (int y = reach; y < height - reach; ++y)
    for (int x = reach; x < width - reach; ++x) {
      const float here = hard[size_t(y * width + x)];
      bool same = true;
      for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx)
          same = same && hard[size_t((y + dy) * width + x + dx)] == here;
      if (!same) continue;
      (here > 0 ? lit : shadowed) += 1;
      wrong += std::abs(soft[size_t(y * width + x)] - here) > tolerance;
    }
  EXPECT_GT(shadowed, 50u);
  EXPECT_GT(lit, 1000u);
  EXPECT_LE(double(wrong), 0.002 * double(lit + shadowed));
}

// A straight edge of a square above a floor, deep in the shadow nothing else: a
// kernel's penumbra is monotonous and passes one half near the hard edge, so
// the shadow's area stays.
TEST(MomentShadows, FilteringKeepsTheShadowsArea) {
  const Scene scene = floor_and_square(LightType::spot);
  const RenderSettings s = hard_shadow::settings(true);
  const auto area = [&](const std::string& graph, const Values& set) {
    const auto planes = visibility(graph, scene, with({{"shadow_map", int64_t(512)}}, set), s);
    double sum = 0;
    for (const float v : planes[0]) sum += 1 - v;
    return sum;
  };
  const double hard = area("shadow_mapping", {});
  for (const char* graph : {"vsm", "msm", "evsm", "csm"})
    EXPECT_NEAR(area(graph, {{"kernel", int64_t(15)}}) / hard, 1, 0.15) << graph;
}

TEST(MomentShadows, MipMapsChangeNothingWhereTheMapIsMagnified) {
  const Scene scene = floor_and_square(LightType::spot);
  const Values set = {{"shadow_map", int64_t(32)}, {"kernel", int64_t(3)}};
  const auto plain = visibility("vsm", scene, set, hard_shadow::settings(true))[0];
  const auto mipped =
      visibility("vsm", scene, with(set, {{"mip_maps", true}}), hard_shadow::settings(true))[0];
  EXPECT_EQ(plain, mipped);
  const auto minified =
      visibility("vsm", scene, with(set, {{"mip_maps", true}, {"shadow_map", int64_t(1024)}}))[0];
  EXPECT_NE(visibility("vsm", scene, with(set, {{"shadow_map", int64_t(1024)}}))[0], minified);
}

// Three squares above each other: a share of the kernel nearer still makes the
// variance large deep in the second's shadow.
TEST(MomentShadows, LightLeakReductionDarkensLeaks) {
  Scene scene = floor_and_square(LightType::spot);
  analytic::add(scene, analytic::square(0.5f), {0.6, 4.5, 0.4});
  const RenderSettings s = hard_shadow::settings(true);
  const Reference truth = hard_shadow::trace(scene, s);
  for (const char* graph : kGraphs) {
    const auto leak = [&](double reduction) {
      const auto v =
          visibility(graph, scene, {{"shadow_map", int64_t(256)}, {"light_leak_reduction", reduction}}, s)[0];
      double sum = 0;
      for (size_t i = 0; i < v.size(); ++i)
        if (truth.domain[0][i] == Reference::counted && truth.visibility[0][i] == 0) sum += v[i];
      return sum;
    };
    const double without = leak(0);
    EXPECT_GT(without, 0) << graph;
    EXPECT_LT(leak(0.3), 0.75 * without) << graph;
  }
}

// ------------------------------------------------------------------------------------------------
// ranges

TEST(MomentShadows, EveryKernelIsInRange) {
  Scene scene = floor_and_square(LightType::spot);
  for (const char* graph : kGraphs)
    for (const int64_t kernel : {1, 15})
      expect_in_range(graph, scene, {{"shadow_map", int64_t(64)}, {"kernel", kernel}});
  scene.lights.push_back(light(LightType::directional, {-3, 5, 2}));
  scene.lights.push_back(light(LightType::point, {-4, 4, -3}));
  for (const auto& [graph, set] : variants())
    expect_in_range(graph, scene, with(set, {{"shadow_map", int64_t(64)}, {"kernel", int64_t(63)}}));
}

// A floor alone under a light that looks straight down at it: one depth in all
// of the map, in a range fitted to it.
TEST(MomentShadows, ConstantDepthIsLit) {
  Scene scene;
  analytic::add(scene, analytic::square(20), {0, 0, 0});
  scene.cameras.push_back(analytic::camera({6, 8, 7}, {0, 0, 0}));
  scene.lights.push_back(light(LightType::directional, {0, 7, 0}));
  for (const auto& [graph, set] : variants()) {
    const auto v = visibility(graph, scene, with(set, {{"shadow_map", int64_t(64)}}))[0];
    const bool plain_tail = set.contains("bound");
    const double least = plain_tail ? 0.4 : graph == "csm" ? 0.8 : 0.97;
    EXPECT_GE(*std::min_element(v.begin(), v.end()), least) << graph << " " << set.size();
    EXPECT_LE(*std::max_element(v.begin(), v.end()), 1) << graph;
  }
}

// A speck just before the light stretches the fitted range to its limit.
TEST(MomentShadows, DepthRangesOfAMillionAreInRange) {
  Scene scene = floor_and_square(LightType::spot);
  analytic::add(scene, analytic::square(1e-4f), {1.5, 7 - 1e-5, 1});
  for (const auto& [graph, set] : variants())
    expect_in_range(graph, scene, with(set, {{"shadow_map", int64_t(128)}}));
  for (const char* graph : kGraphs)
    expect_in_range(graph, scene, {{"shadow_map", int64_t(128)}, {"depth", "linear"}});
}

TEST(MomentShadows, SmallestMapsAndEveryBiasAreInRange) {
  const Scene scene = floor_and_square(LightType::spot);
  for (const char* graph : kGraphs)
    for (const int64_t map : {16, 17}) expect_in_range(graph, scene, {{"shadow_map", map}});
  for (const char* bias : {"none", "constant", "slope_scaled", "normal_offset", "back_face", "midpoint"})
    expect_in_range("msm", scene, {{"shadow_map", int64_t(64)}, {"bias", bias}, {"bias_kernel", 1.0}});
}

TEST(MomentShadows, WhatWouldOverflowIsRefused) {
  const auto complaint = [](const std::string& graph, const Values& set) -> std::string {
    try {
      const Renderer renderer(device(), std::make_shared<Scene>(floor_and_square(LightType::spot)),
                              load_graph(find_graph(graph), set), small());
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  const auto refuses = [&](const std::string& graph, const Values& set, const std::string& parameter,
                           const std::string& limit) {
    const std::string text = complaint(graph, set);
    EXPECT_NE(text.find("'" + parameter + "'"), std::string::npos) << graph << ": " << text;
    EXPECT_NE(text.find(limit), std::string::npos) << graph << ": " << text;
  };
  refuses("esm", {{"exponent", 89.0}}, "exponent", "88.7");
  refuses("esm", {{"exponent", 12.0}, {"precision", "half"}}, "exponent", "11.08");
  refuses("evsm", {{"exponent", 43.0}}, "exponent", "42");
  refuses("evsm", {{"exponent", 6.0}, {"negative_exponent", 5.0}, {"precision", "half"}}, "exponent", "5.54");
  refuses("evsm", {{"exponent", 5.0}, {"negative_exponent", 6.0}, {"precision", "half"}}, "negative_exponent",
          "5.54");
  refuses("gsm", {{"exponent", 60.0}, {"basis", "exponential_variance"}}, "exponent", "42");
  refuses("vsm", {{"kernel", int64_t(8)}}, "kernel", "odd");
  refuses("vsm", {{"kernel", int64_t(65)}}, "kernel", "63");
  refuses("esm", {{"space", "log"}, {"mip_maps", true}}, "mip_maps", "false");
  EXPECT_EQ(complaint("esm", {{"space", "log"}, {"exponent", 500.0}}), "");
}

}  // namespace
}  // namespace gnomon
