// What a scene does not need is left out, and the image stays: every graph, for each fact that allows it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/light/scene_facts.h"
#include "engine/plan/compile.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/parameter_name.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

constexpr double kSame = 1.0 / 1024;  // values of a pixel that count as the same

struct Shown {
  Image color, visibility;
  std::set<std::string> passes;
  std::vector<LeftOutPass> left_out;
  std::map<std::string, double> facts;
};

// The last of `frames` frames.
Shown show(const std::string& graph, const Scene& scene, bool keep_all, const Values& set = {},
           int frames = 1) {
  const auto device = hard_shadow::device();
  const size_t messages = validation_messages(*device).size();
  RenderSettings s = hard_shadow::settings(true, 64, 48);
  s.keep_all = keep_all;
  Values all = set;
  const Graph plain = load_graph(find_graph(graph));
  for (const auto& [name, value] : Values{{"shadow_map", int64_t{64}}, {"samples", int64_t{9}}})
    if (plain.vars.contains(name) && !all.contains(name)) all[name] = value;
  Renderer renderer(device, std::make_shared<Scene>(scene), load_graph(find_graph(graph), all), s);
  for (int i = 0; i < frames; ++i) renderer.render(TimingMode::none);
  const auto passes = renderer.passes();
  Shown shown{renderer.read("color"),
              renderer.read("visibility"),
              {passes.begin(), passes.end()},
              renderer.left_out(),
              renderer.facts()};
  for (size_t i = messages; i < validation_messages(*device).size(); ++i)
    ADD_FAILURE() << validation_messages(*device)[i];
  return shown;
}

double largest_difference(const Image& a, const Image& b) {
  if (a.data.size() != b.data.size()) return INFINITY;
  double most = 0;
  for (size_t i = 0; i < a.data.size(); ++i) {
    const double difference = std::abs(double(a.data[i]) - double(b.data[i]));
    most = difference <= most ? most : std::isnan(difference) ? INFINITY : difference;
  }
  return most;
}

void expect_same(const Shown& lean, const Shown& full) {
  EXPECT_LE(largest_difference(lean.color, full.color), kSame);
  EXPECT_LE(largest_difference(lean.visibility, full.visibility), kSame);
  EXPECT_TRUE(full.left_out.empty());
}

bool left_out(const Shown& shown, const std::string& pass, const std::string& part, const std::string& why) {
  return std::any_of(shown.left_out.begin(), shown.left_out.end(), [&](const LeftOutPass& one) {
    return (pass.empty() || one.pass == pass) && one.part.find(part) != std::string::npos &&
           one.reason.find(why) != std::string::npos;
  });
}

std::vector<std::string> graphs() {
  std::vector<std::string> names;
  for (const auto& file : all_graphs()) names.push_back(file.stem().string());
  return names;
}

bool has_pass(const std::string& graph, const std::string& type) {
  for (const GraphNode& node : load_graph(find_graph(graph)).nodes)
    if (node.type == type) return true;
  return false;
}

Light spot() {
  Light light = analytic::light(LightType::spot, {1, 6, 1});
  light.area = AreaLight{AreaLight::Shape::rectangle, 0.5, 0.5, {}, {}};
  return light;
}

void add_ids(const std::vector<GraphNode>& nodes, std::set<std::string>& ids) {
  for (const GraphNode& node : nodes) {
    if (node.body.empty()) ids.insert(node.id);
    add_ids(node.body, ids);
  }
}

// The passes of a graph that are not its technique's own.
std::set<std::string> beside_technique(const std::string& name) {
  const Graph graph = load_graph(find_graph(name));
  std::set<std::string> ids;
  add_ids(graph.nodes, ids);
  for (const std::string& own : technique_passes(graph, {})) ids.erase(own);
  return ids;
}

// Moments of a wide kernel shade a slope by themselves. That is the technique's own error, and stays.
bool darkens_lit_surfaces(const std::string& graph) { return has_pass(graph, "moment_test"); }

class EveryGraphLeavesOut : public testing::TestWithParam<std::string> {
 protected:
  // The technique is gone: what is left needs only the G-buffer.
  void expect_technique_gone(const Scene& scene, const std::string& why) {
    const Shown lean = show(GetParam(), scene, false), full = show(GetParam(), scene, true);
    expect_same(lean, full);
    if (darkens_lit_surfaces(GetParam()) && why == SceneFacts::no_caster) {
      // What is gone has another reason: that the light has no size.
      for (const std::string& pass : full.passes)
        EXPECT_TRUE(lean.passes.contains(pass) || !left_out(lean, pass, {}, why)) << pass;
      EXPECT_TRUE(lean.passes.contains("map"));
      return;
    }
    EXPECT_EQ(lean.passes, beside_technique(GetParam()));
    EXPECT_TRUE(left_out(lean, {}, {}, why));
  }
};

// A floor alone throws no shadow on itself.
TEST_P(EveryGraphLeavesOut, NoCasterReachesWhatTheCameraSees) {
  Scene scene;
  analytic::add(scene, analytic::square(20), {0, 0, 0});
  scene.cameras.push_back(analytic::camera({6, 8, 7}, {0, 0, 0}));
  scene.lights.push_back(spot());
  expect_technique_gone(scene, SceneFacts::no_caster);
}

// The blocker's shadow falls far behind the camera.
TEST_P(EveryGraphLeavesOut, CastersWhoseShadowsAreOutOfView) {
  Scene scene;
  analytic::add(scene, analytic::square(4), {0, 0, 0});
  analytic::add(scene, analytic::square(4), {40, 0, 0});
  analytic::add(scene, analytic::square(1), {40, 2, 0});
  scene.cameras.push_back(analytic::camera({3, 4, 3}, {0, 0, 0}));
  scene.lights.push_back(analytic::light(LightType::directional, {0.2, 5, 0.1}));
  expect_technique_gone(scene, SceneFacts::no_caster);
}

TEST_P(EveryGraphLeavesOut, LightsOutOfRange) {
  Scene scene = analytic::square_over_plane(spot());
  scene.lights[0].world_from_light = analytic::frame({1, 60, 1}, {0, 0, 0}, {0, 0, 1});
  scene.lights[0].range = 30;
  const Shown lean = show(GetParam(), scene, false), full = show(GetParam(), scene, true);
  EXPECT_LE(largest_difference(lean.color, full.color), kSame);  // visibility is free where no light comes
  EXPECT_EQ(lean.passes, beside_technique(GetParam()));
  EXPECT_TRUE(left_out(lean, {}, {}, "within the light's range"));
}

// The camera looks at the plane's dark side, on which nothing else stands.
TEST_P(EveryGraphLeavesOut, ReceiversThatFaceAway) {
  Material both;
  both.double_sided = true;
  Scene scene;
  analytic::add(scene, analytic::square(4), {0, 0, 0}, both);
  analytic::add(scene, analytic::square(1), {0, 2, 0}, both);
  scene.cameras.push_back(analytic::camera({0.5, -3, 0.5}, {0, 0, 0}));
  scene.lights.push_back(spot());
  expect_technique_gone(scene, "faces away from the light");
}

// One of two lights throws no shadow.
TEST_P(EveryGraphLeavesOut, OneLightOfTwo) {
  Scene scene = analytic::square_over_plane(spot());
  scene.lights.push_back(analytic::light(LightType::spot, {30, 3, 30}, {60, 0, 60}));
  scene.lights.back().map_fov = 0.5;
  scene.lights.back().name = "away";
  const Shown lean = show(GetParam(), scene, false), full = show(GetParam(), scene, true);
  expect_same(lean, full);
  if (has_pass(GetParam(), "shadow_map")) {
    EXPECT_TRUE(left_out(lean, "map", "casters of light 'away'", "is in the light's frustum"));
  }
}

// Half of the casters are behind the camera, and their shadows too.
TEST_P(EveryGraphLeavesOut, CastersThatTheMapDoesNotNeed) {
  Scene scene;
  analytic::add(scene, analytic::square(30), {0, 0, 0});
  for (int i = 0; i < 6; ++i)
    analytic::add(scene, analytic::square(0.5), {i < 3 ? -2.0 + 2 * i : 24.0, 1, i});
  scene.cameras.push_back(analytic::camera({0, 6, 8}, {0, 0, 0}));
  scene.lights.push_back(analytic::light(LightType::directional, {0.5, 5, 0.5}));
  // A map so fine that what filters and walks read around a receiver is less than the casters are apart.
  Values fine;
  if (has_pass(GetParam(), "shadow_map")) fine["shadow_map"] = int64_t{512};
  const Shown lean = show(GetParam(), scene, false, fine), full = show(GetParam(), scene, true, fine);
  expect_same(lean, full);
  // A table or a pyramid is made of all of the map.
  const bool reads_all = has_pass(GetParam(), "summed_area_table") || has_pass(GetParam(), "min_max_pyramid");
  if (!has_pass(GetParam(), "shadow_map") || reads_all) return;
  EXPECT_TRUE(left_out(lean, "map", "3 of 7 draws", "cannot reach what the camera sees"));
  EXPECT_EQ(lean.facts.at("map.draws"), 4);
  EXPECT_EQ(full.facts.at("map.draws"), 7);
}

// Nothing moves: the second frame finds the first one's maps.
TEST_P(EveryGraphLeavesOut, MapsOfAStillScene) {
  if (!load_graph(find_graph(GetParam())).vars.contains("cache")) return;  // it has no maps to keep
  const Scene scene = analytic::square_over_plane(spot());
  const Shown kept = show(GetParam(), scene, false, {{"cache", true}}, 2);
  const Shown drawn = show(GetParam(), scene, true, {{"cache", false}}, 2);
  EXPECT_LE(largest_difference(kept.color, drawn.color), kSame);
  EXPECT_LE(largest_difference(kept.visibility, drawn.visibility), kSame);
  for (const char* figure : {"map.draws", "light.maps_rendered", "refine.maps_rendered"})
    if (kept.facts.contains(figure)) {
      EXPECT_EQ(kept.facts.at(figure), 0) << figure;
    }
}

// Penumbrae, silhouettes and masked materials: only the tiles and pixels that need work get it.
TEST_P(EveryGraphLeavesOut, TilesWithoutPenumbra) {
  const Scene scene = analytic::square_over_plane(spot());
  const Shown lean = show(GetParam(), scene, false), full = show(GetParam(), scene, true);
  expect_same(lean, full);
  if (has_pass(GetParam(), "shadow_map")) {
    EXPECT_TRUE(left_out(lean, "map", "fragment shader", "no material is alpha-masked"));
  }
}

TEST_P(EveryGraphLeavesOut, LightsWithoutSize) {
  Scene scene = analytic::square_over_plane(spot());
  scene.lights[0].area->width = scene.lights[0].area->height = 1e-6;
  const Shown lean = show(GetParam(), scene, false), full = show(GetParam(), scene, true);
  expect_same(lean, full);
  for (const char* figure : {"light.light_samples", "refine.light_samples"})
    if (lean.facts.contains(figure)) {
      EXPECT_EQ(lean.facts.at(figure), 1) << figure;
    }
}

INSTANTIATE_TEST_SUITE_P(All, EveryGraphLeavesOut, testing::ValuesIn(graphs()), test::ParameterName());

// More lights than the G-buffer has room for.
TEST(LeavingOut, ManyLightsWithoutShadows) {
  Scene scene;
  analytic::add(scene, analytic::square(20), {0, 0, 0});
  scene.cameras.push_back(analytic::camera({6, 8, 7}, {0, 0, 0}));
  for (int i = 0; i < 7; ++i) scene.lights.push_back(analytic::light(LightType::spot, {i - 3.0, 6, 1}));
  const Shown lean = show("pcf", scene, false), full = show("pcf", scene, true);
  expect_same(lean, full);
  EXPECT_EQ(lean.passes, (std::set<std::string>{"gbuffer", "unshadowed", "shade"}));
}

TEST(LeavingOut, ChannelsThatNobodyReads) {
  Graph graph = load_graph(find_graph("shadow_mapping"));
  graph.outputs.erase("color");
  RenderSettings s = hard_shadow::settings(true, 64, 48);
  const auto scene = std::make_shared<Scene>(analytic::square_over_plane(spot()));
  Renderer lean(hard_shadow::device(), scene, graph, s);
  s.keep_all = true;
  Renderer full(hard_shadow::device(), scene, graph, s);
  lean.render(TimingMode::none), full.render(TimingMode::none);
  EXPECT_LE(largest_difference(lean.read("visibility"), full.read("visibility")), kSame);
  std::set<std::string> channels;
  for (const LeftOutPass& one : lean.left_out())
    if (one.pass == "gbuffer") channels.insert(one.part);
  EXPECT_EQ(channels, (std::set<std::string>{"channel albedo", "channel normal"}));
  EXPECT_LT(lean.memory().transient_bytes_without_aliasing, full.memory().transient_bytes_without_aliasing);
}

// Receivers that a min-max map shows to be all lit or all in umbra are not filtered.
TEST(LeavingOut, WindowsThatTheMinMaxMapDecides) {
  Light below = spot();
  below.world_from_light = analytic::frame({-3, 4, 2}, {0, 0, 0}, {0, 0, 1});
  for (const Light& light : {spot(), below, analytic::light(LightType::point, {1, 5, 1})})
    for (const char* sampling : {"box", "smooth_box", "vogel"})
      for (const int64_t kernel : {1, 7, 31, 63}) {
        const Scene scene = analytic::square_over_plane(light);
        const auto with = [&](bool min_max) {
          return show("pcf", scene, false,
                      {{"min_max", min_max},
                       {"kernel", kernel},
                       {"sampling", std::string(sampling)},
                       {"shadow_map", int64_t{250}}});
        };
        EXPECT_EQ(largest_difference(with(true).visibility, with(false).visibility), 0) << sampling << kernel;
      }
}

TEST(LeavingOut, FiltersNarrowerThanAPixel) {
  for (const char* graph : {"edtsm", "edtsm_bilateral"}) {
    const Scene scene = analytic::square_over_plane(spot());
    const Values narrow{{"filter", 0.005}};
    const Shown lean = show(graph, scene, false, narrow), full = show(graph, scene, true, narrow);
    expect_same(lean, full);
    EXPECT_TRUE(left_out(lean, {}, {}, "nowhere wider than a pixel")) << graph;
  }
}

}  // namespace
}  // namespace gnomon
