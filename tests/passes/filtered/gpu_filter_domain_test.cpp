// Filters of shadow tests and of hard shadows over their stated domain: finite and in [0, 1] whatever the
// map, the kernel and the range of depths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using analytic::light;

struct Setting {
  std::string graph;
  Values set;
};
std::vector<Setting> settings() {
  return {{"pcf", {{"kernel", int64_t(1)}}},
          {"pcf", {{"kernel", int64_t(63)}}},
          {"pcf", {{"kernel", int64_t(63)}, {"sampling", "smooth_box"}}},
          {"pcf", {{"sampling", "vogel"}}},
          {"rpcf", {{"kernel", int64_t(1)}}},
          {"rpcf", {{"kernel", int64_t(63)}}},
          {"rbsm_filtered", {{"max_size", int64_t(1024)}}},
          {"edtsm", {{"filter", 1.0}}},
          {"edtsm", {{"filter", 63.0}, {"penumbra", 3.0}}},
          {"edtsm", {{"metric", "screen"}}},
          {"edtsm_bilateral", {{"filter", 31.0}}}};
}

std::string text(const Setting& s) {
  std::string all = s.graph;
  for (const auto& [name, value] : s.set) all += ", " + name + " " + to_string(value);
  return all;
}

// Every value of the frame, after the check.
std::vector<float> in_range(const Setting& setting, const Scene& scene, std::int64_t map) {
  Values set = setting.set;
  set["shadow_map"] = map;
  std::vector<float> all;
  for (const auto& plane :
       hard_shadow::visibility(setting.graph, scene, hard_shadow::settings(true, 96, 72), set))
    all.insert(all.end(), plane.begin(), plane.end());
  const auto bad = std::find_if(all.begin(), all.end(), [](float v) { return !(v >= 0 && v <= 1); });
  if (bad != all.end()) ADD_FAILURE() << text(setting) << ", map " << map << ": " << *bad;
  return all;
}

Scene floor_and_square(const Light& l) { return analytic::square_over_plane(l); }

TEST(FilterDomain, MapsFromSixteenTexelsOn) {
  Scene scene = floor_and_square(light(LightType::spot, {1.5, 7, 1}));
  scene.lights.push_back(light(LightType::point, {-4, 4, -3}));
  for (const Setting& s : settings())
    for (const std::int64_t map : {16, 17, 256}) in_range(s, scene, map);
}

// One depth in all of the map: nothing casts a shadow, and nothing may be in one.
TEST(FilterDomain, ConstantDepthIsLit) {
  Scene scene;
  analytic::add(scene, analytic::square(20), {0, 0, 0});
  scene.cameras.push_back(analytic::camera({6, 8, 7}, {0, 0, 0}));
  scene.lights.push_back(light(LightType::directional, {0, 7, 0}));
  for (const Setting& s : settings())
    for (const float v : in_range(s, scene, 64)) ASSERT_GE(v, 1 - 1e-6f) << text(s);
}

// A speck just before the light stretches the fitted range to its limit.
TEST(FilterDomain, DepthRangesOfAMillion) {
  Scene scene = floor_and_square(light(LightType::spot, {1.5, 7, 1}));
  analytic::add(scene, analytic::square(1e-4f), {1.5, 7 - 1e-5, 1});
  for (Setting s : settings())
    for (const char* depth : {"perspective", "linear"}) {
      s.set["depth"] = depth;
      const auto v = in_range(s, scene, 128);
      EXPECT_LT(*std::min_element(v.begin(), v.end()), 0.5f) << text(s) << ": no shadow is left";
    }
}

TEST(FilterDomain, WhatIsOutsideIsRefused) {
  const auto refused = [](const std::string& graph, const Values& set) {
    EXPECT_THROW(load_graph(find_graph(graph), set), Error) << graph;
  };
  refused("pcf", {{"kernel", int64_t(2)}});
  refused("pcf", {{"kernel", int64_t(65)}});
  refused("rpcf", {{"kernel", int64_t(0)}});
  refused("rpcf", {{"max_size", int64_t(256)}});
  refused("edtsm", {{"filter", 64.0}});
  refused("edtsm", {{"penumbra", -1.0}});
}

}  // namespace
}  // namespace gnomon
