// What the compiler leaves out of the shipped graphs, without a device.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "engine/light/scene_facts.h"
#include "engine/plan/compile.h"

namespace gnomon {
namespace {

SceneFacts facts(const std::string& shadowless) {
  SceneFacts facts;
  facts.lights = 1;
  facts.shadowless = {shadowless};
  facts.light_moves = {false};
  facts.light_size = {0};
  facts.penumbra = {0};
  return facts;
}

Plan plan_of(const std::string& graph, const Values& set, const SceneFacts& facts,
             const CompileOptions& options = {}) {
  return compile(load_graph(find_graph(graph), set), {}, facts, options);
}

const PlanNode& node_of(const Plan& plan, const std::string& id) {
  return *std::find_if(plan.nodes.begin(), plan.nodes.end(), [&](const PlanNode& n) { return n.id == id; });
}

std::vector<std::string> ids_of(const Plan& plan) {
  std::vector<std::string> ids;
  for (const PlanNode& node : plan.nodes) ids.push_back(node.id);
  return ids;
}

SceneFacts shadowless(uint32_t lights) {
  SceneFacts f = facts("far away");
  f.lights = lights;
  f.shadowless.assign(lights, "far away");
  return f;
}

Plan without_shadows(const Graph& graph, uint32_t lights) {
  Declaration::Setting setting;
  setting.lights = lights;
  return compile(graph, setting, shadowless(lights));
}

std::string shown(const Plan& plan) { return plan.resources[plan.outputs.at("visibility")].name; }

std::string read_by(const Plan& plan, const std::string& id, const std::string& input) {
  return plan.resources[node_of(plan, id).resources.at(input)].name;
}

// Passes that make what stands in for the technique, as they declare it: by name, no others.
TEST(WithoutShadows, VisibilityComesFromTheGBufferAlone) {
  const Plan few = without_shadows(load_graph(find_graph("edtsm")), 4);
  EXPECT_EQ(shown(few), "gbuffer.unshadowed");
  EXPECT_EQ(read_by(few, "shade", "visibility"), "gbuffer.unshadowed");
  const Plan many = without_shadows(load_graph(find_graph("edtsm")), 5);
  EXPECT_EQ(shown(many), "unshadowed.visibility");
  EXPECT_EQ(read_by(many, "shade", "visibility"), "unshadowed.visibility");
  EXPECT_EQ(read_by(many, "unshadowed", "depth"), "gbuffer.depth");
  EXPECT_EQ(ids_of(many), (std::vector<std::string>{"gbuffer", "unshadowed", "shade"}));
}

TEST(WithoutShadows, OnlyOfGraphsThatHaveWhatItTakes) {
  Graph graph = load_graph(find_graph("pcf"));
  Graph blind = graph;
  blind.outputs.erase("visibility");
  EXPECT_EQ(without_shadows(blind, 1).nodes.size(), graph.nodes.size());
  // An id of the graph's own is not taken.
  for (GraphNode& node : graph.nodes) {
    if (node.id == "map") node.id = "unshadowed";
    for (auto& [input, ref] : node.in)
      if (ref.node == "map") ref.node = "unshadowed";
  }
  EXPECT_EQ(shown(without_shadows(graph, 30)), "unshadowed_.visibility");
}

// What stands in is there only where it does: also of a run that keeps all.
TEST(WithoutShadows, TheSubstituteCostsNothingElse) {
  for (const bool keep_all : {false, true}) {
    CompileOptions options;
    options.keep_all = keep_all;
    EXPECT_FALSE(node_of(plan_of("pcf", {}, facts(""), options), "gbuffer").resources.contains("unshadowed"));
  }
}

TEST(WithoutShadows, WhatIsTheTechniquesOwn) {
  EXPECT_EQ(technique_passes(load_graph(find_graph("edtsm")), {}),
            (std::set<std::string>{"views", "map", "hard", "edt", "soft", "mean"}));
  EXPECT_EQ(technique_passes(load_graph(find_graph("area_adaptive")), {}),
            (std::set<std::string>{"views", "refine", "resolve"}));
  for (const auto& file : all_graphs()) EXPECT_FALSE(technique_passes(load_graph(file), {}).empty()) << file;
}

TEST(LeftOutOfThePlan, ATechniqueWhoseShadowsNobodySees) {
  const Plan plan = plan_of("edtsm", {}, facts("far away"));
  EXPECT_EQ(ids_of(plan), (std::vector<std::string>{"gbuffer", "shade"}));
  ASSERT_EQ(plan.left_out.size(), 6u);
  for (const LeftOut& pass : plan.left_out) EXPECT_EQ(pass.reason, "far away");
  CompileOptions keep;
  keep.keep_all = true;
  EXPECT_EQ(plan_of("edtsm", {}, facts("far away"), keep).nodes.size(), 8u);
}

// What is captured runs all the same, and nothing else does.
TEST(LeftOutOfThePlan, NotWhatIsCaptured) {
  CompileOptions options;
  options.captures = {"map.depth"};
  EXPECT_EQ(ids_of(plan_of("edtsm", {}, facts("far away"), options)),
            (std::vector<std::string>{"gbuffer", "views", "map", "shade"}));
}

// Moments darken slopes by themselves; that a light shines elsewhere is no error of theirs.
TEST(LeftOutOfThePlan, ATechniquesOwnErrorsStay) {
  EXPECT_GT(plan_of("vsm", {}, facts(SceneFacts::no_caster)).nodes.size(), 3u);
  EXPECT_EQ(plan_of("vsm", {}, facts("out of range")).nodes.size(), 2u);
}

TEST(LeftOutOfThePlan, HowFarReadersReachAroundAReceiver) {
  const auto reach = [](const std::string& graph, const Values& set, const CompileOptions& options = {}) {
    return node_of(plan_of(graph, set, facts(""), options), "map").reach.at("depth");
  };
  EXPECT_EQ(reach("shadow_mapping", {}), 1u);
  EXPECT_EQ(reach("pcf", {{"kernel", int64_t{15}}}), 15u / 2 + 2);
  EXPECT_EQ(reach("vsm", {{"kernel", int64_t{31}}}), 31u / 2 + 2);  // the filter's, and the test's own
  EXPECT_EQ(reach("vsm", {{"mip_maps", true}}), std::nullopt);
  CompileOptions options;
  options.captures = {"map.depth"};
  EXPECT_EQ(reach("pcf", {}, options), std::nullopt) << "somebody looks at it";
  options = {};
  options.keep_all = true;
  EXPECT_EQ(reach("pcf", {}, options), std::nullopt);
}

TEST(LeftOutOfThePlan, ChannelsThatNobodyReads) {
  Graph graph = load_graph(find_graph("pcf"));
  graph.outputs.erase("color");
  const Plan plan = compile(graph, {}, facts(""));
  const PlanNode& gbuffer = node_of(plan, "gbuffer");
  EXPECT_TRUE(gbuffer.resources.contains("geometric"));
  EXPECT_FALSE(gbuffer.resources.contains("albedo"));
  EXPECT_FALSE(gbuffer.resources.contains("normal"));
}

}  // namespace
}  // namespace gnomon
