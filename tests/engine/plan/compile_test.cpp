// Plans as text: order, culling, barriers, memory, segments.
#include "engine/plan/compile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "engine/base/error.h"
#include "engine/light/scene_facts.h"
#include "tests/engine/plan/fake_passes.h"

namespace gnomon {
namespace {

class CompileTest : public testing::Test {
 protected:
  void SetUp() override { test::register_fake_passes(); }
};

std::string file_with(const std::string& passes,
                      const std::string& outputs = R"({"visibility": "end.result"})") {
  return R"({"schema": 1, "name": "x", "passes": [)" + passes + R"(], "outputs": )" + outputs + "}";
}

const Declaration::Setting tiny{{8, 8}, 1};  // 256 bytes for one R32_SFLOAT image

SceneFacts facts_with(uint64_t triangles) {
  SceneFacts facts;
  facts.triangles = triangles;
  return facts;
}

Plan plan_of(const std::string& text, uint64_t triangles = 1, const CompileOptions& options = {}) {
  return compile(parse_graph(text, "g.json"), tiny, facts_with(triangles), options);
}

std::string text_of(const std::string& text, uint64_t triangles = 1, const CompileOptions& options = {}) {
  return to_text(plan_of(text, triangles, options));
}

std::vector<std::string> ids(const Plan& plan) {
  std::vector<std::string> result;
  for (const PlanNode& node : plan.nodes) result.push_back(node.id);
  return result;
}
using Ids = std::vector<std::string>;

std::string error_of(const std::string& text, const CompileOptions& options = {}) {
  try {
    plan_of(text, 1, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// One pass: an id, a type and its inputs.
std::string pass(const std::string& id, const std::string& type, const std::string& in = "",
                 const std::string& more = "") {
  return R"({"id": ")" + id + R"(", "type": ")" + type + R"(", "in": {)" + in + "}" + more + "}";
}
std::string from(const std::string& port, const std::string& ref) {
  return "\"" + port + "\": \"" + ref + "\"";
}
std::string source(const std::string& ref) { return from("source", ref); }

// --- use_of ---
TEST(UseOf, StagesAccessesAndLayouts) {
  const Use sampled = use_of(Access::sampled, PassKind::compute, false, VK_FORMAT_R8_UNORM);
  EXPECT_EQ(sampled, (Use{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}));
  const Use depth_map = use_of(Access::sampled, PassKind::raster, false, VK_FORMAT_D32_SFLOAT);
  EXPECT_EQ(depth_map.layout, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
  EXPECT_EQ(depth_map.stages,
            VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
  const Use color = use_of(Access::color, PassKind::raster, false, VK_FORMAT_R8_UNORM);
  EXPECT_EQ(color, (Use{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                        VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                        VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL}));
  const Use depth = use_of(Access::depth, PassKind::raster, false, VK_FORMAT_D32_SFLOAT);
  EXPECT_EQ(depth.layout, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
  EXPECT_EQ(depth.stages,
            VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT);
  const Use test = use_of(Access::depth_test, PassKind::raster, false, VK_FORMAT_D32_SFLOAT);
  EXPECT_EQ(test.access, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT);
  EXPECT_EQ(test.layout, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
  const Use both =
      use_of(Access::depth_test | Access::sampled, PassKind::raster, false, VK_FORMAT_D32_SFLOAT);
  EXPECT_EQ(both.layout, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
  const Use storage =
      use_of(Access::storage_read | Access::storage_write, PassKind::mixed, false, VK_FORMAT_R8_UNORM);
  EXPECT_EQ(storage.layout, VK_IMAGE_LAYOUT_GENERAL);
  EXPECT_EQ(storage.stages, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
                                VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
  const Use arguments =
      use_of(Access::indirect | Access::vertex, PassKind::raster, true, VK_FORMAT_UNDEFINED);
  EXPECT_EQ(arguments,
            (Use{VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT,
                 VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT,
                 VK_IMAGE_LAYOUT_UNDEFINED}));
  const Use counted =
      use_of(Access::storage_write | Access::host_read, PassKind::compute, true, VK_FORMAT_UNDEFINED);
  EXPECT_EQ(counted, (Use{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                          VK_IMAGE_LAYOUT_UNDEFINED}));
  const Use copied = use_of(Access::transfer_read, PassKind::compute, false, VK_FORMAT_R8_UNORM);
  EXPECT_EQ(copied, (Use{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                         VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}));
}

// --- plans as text ---
TEST_F(CompileTest, LinearChain) {
  const std::string graph =
      file_with(pass("draw", "t_source") + "," + pass("f", "t_filter", source("draw.depth")) + "," +
                pass("end", "t_filter", source("f.result")));
  EXPECT_EQ(text_of(graph), R"(passes
  0 draw (t_source)
    out color = #0 draw.color
    out depth = #1 draw.depth
    barrier #0 draw.color: compute/none/undefined -> color_output/color_read|color_write/color_attachment discard
    barrier #1 draw.depth: compute/none/undefined -> early_tests|late_tests/depth_read|depth_write/depth_attachment discard
  1 f (t_filter)
    in source = #1 draw.depth
    out result = #2 f.result
    barrier #1 draw.depth: early_tests|late_tests/depth_write/depth_attachment -> compute/sampled_read/depth_read_only
    barrier #2 f.result: color_output/color_write/undefined -> compute/storage_write/general discard
  2 end (t_filter)
    in source = #2 f.result
    out result = #3 end.result
    barrier #2 f.result: compute/storage_write/general -> compute/sampled_read/read_only
    barrier #3 end.result: transfer/none/undefined -> compute/storage_write/general discard
segments
  0 passes 0..2
final
  barrier #3 end.result: compute/storage_write/general -> transfer/transfer_read/transfer_source
resources
  #0 draw.color: 8x8 R8G8B8A8_UNORM, passes 0..0, heap 0 + 256
  #1 draw.depth: 8x8 D32_SFLOAT, passes 0..1, heap 256 + 256
  #2 f.result: 8x8 R32_SFLOAT, passes 1..2, heap 0 + 256
  #3 end.result: 8x8 R32_SFLOAT, passes 2..2, own memory, exported
outputs
  visibility = #3 end.result
heap 512 bytes, 768 without aliasing
)");
}

// One barrier for both readers: reads after reads need none.
TEST_F(CompileTest, Diamond) {
  const std::string graph =
      file_with(pass("a", "t_value") + "," + pass("l", "t_filter", source("a.result")) + "," +
                pass("r", "t_filter", source("a.result")) + "," +
                pass("end", "t_blend", from("a", "l.result") + "," + from("b", "r.result")));
  const Plan plan = plan_of(graph);
  EXPECT_EQ(ids(plan), (Ids{"a", "l", "r", "end"}));
  int barriers_of_a = 0;
  for (const PlanNode& node : plan.nodes)
    for (const Barrier& barrier : node.barriers)
      barriers_of_a += plan.resources[barrier.resource].name == "a.result";
  EXPECT_EQ(barriers_of_a, 2);  // first use, and the readers'
}

TEST_F(CompileTest, StableOrder) {
  // "z" depends on nothing and comes first in the file; "end" waits for what follows it in the file
  const std::string graph =
      file_with(pass("z", "t_value") + "," +
                    pass("end", "t_blend", from("a", "b.result") + "," + from("b", "z.result")) + "," +
                    pass("c", "t_filter", source("z.result")) + "," +
                    pass("b", "t_filter", source("c.result")) + "," + pass("y", "t_value"),
                R"({"visibility": "end.result", "other": "y.result"})");
  EXPECT_EQ(ids(plan_of(graph)), (Ids{"z", "c", "b", "end", "y"}));
  EXPECT_EQ(text_of(graph), text_of(graph));
}

TEST_F(CompileTest, CulledBranch) {
  const std::string graph = file_with(pass("a", "t_value") + "," + pass("x", "t_filter", source("a.result")) +
                                      "," + pass("y", "t_filter", source("x.result")) + "," +
                                      pass("end", "t_filter", source("a.result")));
  const Plan plan = plan_of(graph);
  EXPECT_EQ(ids(plan), (Ids{"a", "end"}));
  ASSERT_EQ(plan.left_out.size(), 2u);
  EXPECT_EQ(plan.left_out[0].id, "x");
  EXPECT_EQ(plan.left_out[0].reason, "no output or capture needs it");
  CompileOptions capture;
  capture.captures = {"x.result", "y.source"};  // an input: what is connected to it
  const Plan captured = plan_of(graph, 1, capture);
  EXPECT_EQ(ids(captured), (Ids{"a", "x", "end"}));
  EXPECT_EQ(captured.captures.at("x.result"), captured.captures.at("y.source"));
  EXPECT_TRUE(captured.resources[captured.captures.at("x.result")].exported);
}

TEST_F(CompileTest, FoldedConstant) {
  const std::string graph = file_with(
      pass("a", "t_value") + "," + pass("h", "t_constant", source("a.result")) + "," + pass("b", "t_value") +
      "," + pass("end", "t_blend", from("a", "h.result") + "," + from("b", "b.result")));
  EXPECT_EQ(ids(plan_of(graph, 1)), (Ids{"a", "h", "b", "end"}));
  const Plan plan = plan_of(graph, 0);
  EXPECT_EQ(ids(plan), (Ids{"b", "end"}));
  EXPECT_EQ(plan.nodes[1].constant_inputs, (std::map<std::string, bool>{{"a", true}}));
  const Resource& constant = plan.resources[plan.nodes[1].resources.at("a")];
  ASSERT_TRUE(constant.constant);
  EXPECT_EQ((*constant.constant)[0], 1.0f);
  EXPECT_EQ(constant.image.extent, (Extent{1, 1}));
  EXPECT_EQ(constant.initial_layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  EXPECT_TRUE(constant.image_usage & VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  EXPECT_EQ(constant.size, 0u);
  for (const Barrier& barrier : plan.nodes[1].barriers)
    EXPECT_FALSE(plan.resources[barrier.resource].constant);
  ASSERT_EQ(plan.left_out.size(), 2u);
  EXPECT_EQ(plan.left_out[0].reason, "only passes that are left out read it");
  EXPECT_EQ(plan.left_out[1].reason, "nothing casts a shadow");
  CompileOptions keep;
  keep.keep_all = true;
  EXPECT_EQ(ids(plan_of(graph, 0, keep)), (Ids{"a", "h", "b", "end"}));
}

TEST_F(CompileTest, FoldedOutputStaysReadable) {
  const Plan plan =
      plan_of(file_with(pass("a", "t_value") + "," + pass("end", "t_constant", source("a.result"))), 0);
  EXPECT_TRUE(plan.nodes.empty());
  EXPECT_TRUE(plan.segments.empty());
  const Resource& output = plan.resources[plan.outputs.at("visibility")];
  EXPECT_TRUE(output.constant && output.exported);
  EXPECT_EQ(output.initial_layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  EXPECT_TRUE(plan.final_barriers.empty());
}

// A constant that is sampled and read back goes from one layout to the other and back, every frame.
TEST_F(CompileTest, ConstantInTwoLayouts) {
  const Plan plan =
      plan_of(file_with(pass("a", "t_value") + "," + pass("h", "t_constant", source("a.result")) + "," +
                            pass("end", "t_filter", source("h.result")),
                        R"({"visibility": "end.result", "hard": "h.result"})"),
              0);
  ASSERT_EQ(plan.nodes.size(), 1u);
  const uint32_t constant = plan.outputs.at("hard");
  const auto of_constant = [&](const Barrier& b) { return b.resource == constant; };
  const auto first = std::find_if(plan.nodes[0].barriers.begin(), plan.nodes[0].barriers.end(), of_constant);
  ASSERT_NE(first, plan.nodes[0].barriers.end());
  EXPECT_FALSE(first->discard);
  EXPECT_EQ(first->before.layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  EXPECT_EQ(plan.resources[constant].initial_layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  EXPECT_EQ(std::count_if(plan.final_barriers.begin(), plan.final_barriers.end(), of_constant), 1);
}

TEST_F(CompileTest, Bypass) {
  const std::string graph = file_with(pass("a", "t_value") + "," + pass("p", "t_bypass", source("a.result")) +
                                      "," + pass("q", "t_bypass", source("p.result")) + "," +
                                      pass("end", "t_filter", source("q.result")));
  const Plan plan = plan_of(graph, 0);
  EXPECT_EQ(ids(plan), (Ids{"a", "end"}));
  EXPECT_EQ(plan.nodes[1].resources.at("source"), plan.nodes[0].resources.at("result"));
  EXPECT_EQ(plan.left_out.size(), 2u);
  EXPECT_EQ(plan.left_out[0].reason, "nothing to filter");
}

TEST_F(CompileTest, BypassOfAConstantIsTheConstant) {
  const Plan plan =
      plan_of(file_with(pass("a", "t_value") + "," + pass("h", "t_constant", source("a.result")) + "," +
                        pass("p", "t_bypass", source("h.result")) + "," +
                        pass("end", "t_filter", source("p.result"))),
              0);
  EXPECT_EQ(ids(plan), (Ids{"end"}));
  EXPECT_TRUE(plan.nodes[0].constant_inputs.contains("source"));
}

// What is modified in place must have memory of its own, so the bypass has to run.
TEST_F(CompileTest, NoBypassIntoOrAroundAModifier) {
  const std::string a = pass("a", "t_value") + "," + pass("p", "t_bypass", source("a.result")) + ",";
  const std::string into =
      file_with(a + pass("m", "t_modify", from("target", "p.result")) + "," +
                pass("end", "t_blend", from("a", "a.result") + "," + from("b", "m.target")));
  EXPECT_EQ(ids(plan_of(into, 0)), (Ids{"a", "p", "m", "end"}));
  const std::string around =
      file_with(a + pass("m", "t_modify", from("target", "a.result")) + "," +
                pass("end", "t_blend", from("a", "p.result") + "," + from("b", "m.target")));
  EXPECT_EQ(ids(plan_of(around, 0)), (Ids{"a", "p", "m", "end"}));
}

TEST_F(CompileTest, ReadersRunBeforeTheModifier) {
  // in file order the modifier would come first
  const std::string graph =
      file_with(pass("a", "t_value") + "," + pass("m", "t_modify", from("target", "a.result")) + "," +
                pass("r", "t_filter", source("a.result")) + "," +
                pass("end", "t_blend", from("a", "m.target") + "," + from("b", "r.result")));
  const Plan plan = plan_of(graph);
  EXPECT_EQ(ids(plan), (Ids{"a", "r", "m", "end"}));
  EXPECT_EQ(plan.nodes[2].resources.at("target"), plan.nodes[0].resources.at("result"));
  // write after read: execution only
  const Barrier& barrier = plan.nodes[2].barriers[0];
  EXPECT_EQ(barrier.before,
            (Use{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, 0, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}));
  EXPECT_EQ(barrier.after.layout, VK_IMAGE_LAYOUT_GENERAL);
  EXPECT_FALSE(barrier.discard);
}

TEST_F(CompileTest, HostReadCutsASegment) {
  const std::string graph =
      file_with(pass("a", "t_value") + "," + pass("count", "t_count", source("a.result")) + "," +
                pass("b", "t_value") + "," + pass("host", "t_host", from("count", "count.count")) + "," +
                pass("end", "t_blend", from("a", "host.result") + "," + from("b", "b.result")));
  const Plan plan = plan_of(graph);
  ASSERT_EQ(plan.segments.size(), 2u);
  EXPECT_EQ(plan.segments[0].last, 2u);
  EXPECT_TRUE(plan.segments[0].host_wait);
  EXPECT_EQ(plan.segments[0].reason, "'host' reads 'count.count' on the host");
  EXPECT_FALSE(plan.segments[1].host_wait);
  ASSERT_EQ(plan.segments[0].end_barriers.size(), 1u);
  EXPECT_EQ(plan.segments[0].end_barriers[0].before,
            (Use{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                 VK_IMAGE_LAYOUT_UNDEFINED}));
  EXPECT_EQ(plan.segments[0].end_barriers[0].after,
            (Use{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED}));
  const Resource& count = plan.resources[plan.nodes[1].resources.at("count")];
  EXPECT_TRUE(count.host_visible);
  EXPECT_EQ(count.size, 0u);
}

TEST_F(CompileTest, NobodyReadsOnTheHostNobodyWaits) {
  const Plan plan =
      plan_of(file_with(pass("a", "t_value") + "," + pass("count", "t_count", source("a.result")) + "," +
                            pass("end", "t_filter", source("a.result")),
                        R"({"visibility": "end.result", "count": "count.count"})"));
  EXPECT_EQ(plan.segments.size(), 1u);
}

TEST_F(CompileTest, TwoCountersAreWaitedForOnce) {
  const std::string graph = file_with(
      pass("a", "t_value") + "," + pass("c1", "t_count", source("a.result")) + "," +
      pass("c2", "t_count", source("a.result")) + "," + pass("h1", "t_host", from("count", "c1.count")) +
      "," + pass("h2", "t_host", from("count", "c2.count")) + "," +
      pass("end", "t_blend", from("a", "h1.result") + "," + from("b", "h2.result")));
  const Plan plan = plan_of(graph);
  ASSERT_EQ(plan.segments.size(), 2u);
  EXPECT_EQ(plan.segments[0].last, 3u);
  EXPECT_EQ(plan.segments[0].end_barriers.size(), 2u);
}

const std::string loop_graph =
    file_with(pass("g", "t_value") + "," + pass("data", "t_buffer") +
              R"(, {"id": "again", "type": "loop", "controller": "decide", "max": 8, "passes": [)" +
              pass("work", "t_filter", source("g.result")) + "," +
              pass("step", "t_step", from("state", "data.data") + "," + from("guide", "work.result")) + "," +
              pass("decide", "t_decide", from("votes", "step.votes") + "," + source("work.result")) + "]}," +
              pass("end", "t_sum", from("data", "step.state")));

TEST_F(CompileTest, LoopWithController) {
  EXPECT_EQ(text_of(loop_graph), R"(passes
  0 g (t_value)
    out result = #0 g.result
    barrier #0 g.result: compute/none/undefined -> compute/storage_write/general discard
  1 data (t_buffer)
    out data = #1 data.data
    barrier #1 data.data: compute/none -> compute/storage_write discard
  2 work (t_filter)
    in source = #0 g.result
    out result = #2 work.result
    barrier #0 g.result: compute/storage_write/general -> compute/sampled_read/read_only once
    barrier #2 work.result: compute/none/undefined -> compute/storage_write/general discard
  3 step (t_step)
    inout state = #1 data.data
    in guide = #2 work.result
    out votes = #3 step.votes
    barrier #1 data.data: compute/storage_write -> compute/storage_read|storage_write once
    barrier #2 work.result: compute/storage_write/general -> compute/sampled_read/read_only
    barrier #3 step.votes: compute/storage_write -> compute/storage_write discard
  4 decide (t_decide)
    in votes = #3 step.votes
    in source = #2 work.result
    out result = #4 decide.result
    barrier #4 decide.result: compute/storage_write/undefined -> compute/storage_write/general discard
  5 end (t_sum)
    in data = #1 data.data
    out result = #5 end.result
    barrier #1 data.data: compute/storage_write -> compute/storage_read
    barrier #5 end.result: transfer/none/undefined -> compute/storage_write/general discard
segments
  0 passes 0..1
  1 passes 2..3, then the host waits: 'decide' reads 'step.votes' on the host
    barrier #3 step.votes: compute/storage_write -> host/host_read
  2 passes 4..4
  3 passes 5..5
loops
  again segments 1..2, controller decide, at most 8 iterations
    barrier #1 data.data: compute/storage_write -> compute/storage_read|storage_write
final
  barrier #5 end.result: compute/storage_write/general -> transfer/transfer_read/transfer_source
resources
  #0 g.result: 8x8 R32_SFLOAT, passes 0..4, heap 16384 + 256
  #1 data.data: 1024 x vec4 (16 bytes), passes 1..5, heap 0 + 16384
  #2 work.result: 8x8 R32_SFLOAT, passes 2..4, heap 16640 + 256
  #3 step.votes: 4 x uint (4 bytes), passes 2..4, own memory, host visible
  #4 decide.result: 8x8 R32_SFLOAT, passes 2..4, heap 16896 + 256
  #5 end.result: 8x8 R32_SFLOAT, passes 5..5, own memory, exported
outputs
  visibility = #5 end.result
heap 17152 bytes, 17152 without aliasing
)");
}

// The body reads in one layout what it modifies in another: the second turn has to go back.
TEST_F(CompileTest, LoopGoesBackToItsFirstLayout) {
  const std::string graph = file_with(
      pass("a", "t_value") + R"(, {"id": "again", "type": "loop", "controller": "m", "max": 3, "passes": [)" +
      pass("r", "t_filter", source("a.result")) + "," +
      pass("m", "t_modify", from("target", "a.result") + "," + from("guide", "r.result")) + "]}," +
      pass("end", "t_filter", source("m.target")));
  const Plan plan = plan_of(graph);
  ASSERT_EQ(plan.loops.size(), 1u);
  ASSERT_EQ(plan.loops[0].repeat_barriers.size(), 1u);
  const Barrier& repeat = plan.loops[0].repeat_barriers[0];
  EXPECT_EQ(repeat.before, (Use{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                VK_IMAGE_LAYOUT_GENERAL}));
  EXPECT_EQ(repeat.after, (Use{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}));
}

// "m" feeds only the next turn's "r": it is needed although no output reads it.
TEST_F(CompileTest, WhatTheNextTurnReadsIsKept) {
  const std::string graph = file_with(
      pass("a", "t_value") + R"(, {"id": "again", "type": "loop", "controller": "r", "max": 3, "passes": [)" +
      pass("m", "t_modify", from("target", "a.result") + "," + from("guide", "r.result")) + "," +
      pass("r", "t_filter", source("a.result")) + "]}," + pass("end", "t_filter", source("r.result")));
  EXPECT_EQ(ids(plan_of(graph)), (Ids{"a", "r", "m", "end"}));
}

TEST_F(CompileTest, DeadLoopIsLeftOut) {
  const std::string graph =
      file_with(pass("data", "t_buffer") +
                R"(, {"id": "again", "type": "loop", "controller": "decide", "max": 8, "passes": [)" +
                pass("step", "t_step", from("state", "data.data")) + "," +
                pass("decide", "t_decide", from("votes", "step.votes")) + "]}," + pass("end", "t_value"));
  const Plan plan = plan_of(graph);
  EXPECT_EQ(ids(plan), (Ids{"end"}));
  EXPECT_TRUE(plan.loops.empty());
  EXPECT_EQ(plan.left_out.size(), 3u);
}

TEST_F(CompileTest, History) {
  const std::string graph =
      file_with(pass("a", "t_value") + "," +
                pass("h", "t_history", source("a.result") + "," + from("last", "h.result@previous")) + "," +
                pass("end", "t_filter", source("h.result")));
  const Plan plan = plan_of(graph);
  EXPECT_EQ(ids(plan), (Ids{"a", "h", "end"}));
  const PlanNode& node = plan.nodes[1];
  EXPECT_EQ(node.resources.at("last"), node.resources.at("result"));
  EXPECT_TRUE(node.previous_inputs.contains("last"));
  const Resource& history = plan.resources[node.resources.at("result")];
  EXPECT_TRUE(history.history);
  EXPECT_EQ(history.size, 0u);
  // left readable at the end of a frame, which is how the next one reads it: no barrier of its own
  EXPECT_EQ(history.initial_layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  for (const Barrier& barrier : node.barriers) EXPECT_FALSE(barrier.previous);
}

TEST_F(CompileTest, HistoryThatNobodyElseReads) {
  const std::string graph =
      file_with(pass("a", "t_value") + "," +
                    pass("h", "t_history", source("a.result") + "," + from("last", "a.result@previous")),
                R"({"visibility": "h.result"})");
  const Plan plan = plan_of(graph);
  EXPECT_TRUE(plan.resources[plan.nodes[0].resources.at("result")].history);
  const std::string exported =
      file_with(pass("h", "t_history", source("a.result") + "," + from("last", "h.result@previous")) + "," +
                    pass("a", "t_value"),
                R"({"visibility": "h.result"})");
  const Plan other = plan_of(exported);
  const PlanNode& node = other.nodes[1];
  const auto previous =
      std::find_if(node.barriers.begin(), node.barriers.end(), [](const Barrier& b) { return b.previous; });
  ASSERT_NE(previous, node.barriers.end());  // from transfer_read, where the frame before left it
  EXPECT_EQ(previous->before.layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  EXPECT_EQ(previous->after.layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

TEST_F(CompileTest, TransientsLiveForOnePass) {
  const Plan plan =
      plan_of(file_with(pass("a", "t_value") + "," + pass("s", "t_scratch", source("a.result")) + "," +
                        pass("end", "t_scratch", source("s.result"))));
  const Resource& one = plan.resources[plan.nodes[1].resources.at("rows")];
  const Resource& two = plan.resources[plan.nodes[2].resources.at("rows")];
  EXPECT_EQ(one.first, one.last);
  EXPECT_EQ(two.first, two.last);
  EXPECT_EQ(plan.heap_bytes_without_aliasing, 4 * 256u);
  EXPECT_EQ(plan.heap_bytes, 3 * 256u);  // what pass "s" reads, writes, and uses in between
}

TEST_F(CompileTest, AliasingSavesAQuarter) {
  std::string passes = pass("f0", "t_value");
  for (int i = 1; i < 7; ++i)
    passes +=
        "," + pass("f" + std::to_string(i), "t_filter", source("f" + std::to_string(i - 1) + ".result"));
  const std::string graph = file_with(passes, R"({"visibility": "f6.result"})");
  const Plan plan = plan_of(graph);  // six full-screen intermediates
  EXPECT_EQ(plan.heap_bytes_without_aliasing, 6 * 256u);
  EXPECT_EQ(plan.heap_bytes, 2 * 256u);
  EXPECT_LE(plan.heap_bytes, 0.75 * double(plan.heap_bytes_without_aliasing));
  CompileOptions plain;
  plain.alias = false;
  const Plan apart = plan_of(graph, 1, plain);
  EXPECT_EQ(apart.heap_bytes, apart.heap_bytes_without_aliasing);
  EXPECT_EQ(ids(apart), ids(plan));
}

TEST_F(CompileTest, DeviceSaysSizesAndAlignments) {
  CompileOptions options;
  options.memory = [](const Resource& resource) {
    return MemoryNeed{resource.is_buffer ? 100u : 1000u, 512};
  };
  const Plan plan = plan_of(loop_graph, 1, options);
  for (const Resource& resource : plan.resources) EXPECT_EQ(resource.offset % 512, 0u);
}

TEST_F(CompileTest, Errors) {
  CompileOptions options;
  options.captures = {"en.result", "end.resutl", "end", "a.result"};
  const std::string graph =
      file_with(pass("a", "t_value") + "," + pass("m", "t_modify", from("target", "a.result")) + "," +
                pass("end", "t_filter", source("m.target")));
  EXPECT_EQ(error_of(graph, options),
            "g.json: capture 'en.result': unknown pass (did you mean 'end'?)\n"
            "g.json: capture 'end.resutl': unknown port 'resutl' (did you mean 'result'?)\n"
            "g.json: capture 'end': must name a port (write \"pass.port\")\n"
            "g.json: capture 'a.result': is modified in place by 'm' (capture what that one gives out)");
  const std::string huge = file_with(pass("a", "t_huge", "", R"(, "params": {"side": 4294967295})"),
                                     R"({"visibility": "a.result"})");
  EXPECT_EQ(error_of(huge), "no error");  // exported: the device says how large an image may be
  const std::string huge_inside =
      file_with(R"({"id": "b", "type": "t_huge", "params": {"side": 4294967295}}, )" +
                pass("end", "t_filter", source("b.result")));
  EXPECT_NE(error_of(huge_inside).find("has 4096 layers, and 'source' takes a single one"),
            std::string::npos);
}

TEST_F(CompileTest, LayersThatAReaderCannotTakeAreAnError) {
  const Graph graph = parse_graph(
      file_with(pass("a", "t_layers") + "," + pass("end", "t_filter", source("a.result"))), "g.json");
  EXPECT_NO_THROW(compile(graph, {{8, 8}, 1, 1}, {}));
  EXPECT_THROW(compile(graph, {{8, 8}, 3, 1}, {}), Error);
}

// --- properties of plans of random graphs ---

// Walks a plan as a device would, frame by frame, turn by turn, and checks layouts, hazards and memory.
class Simulator {
 public:
  Simulator(const Plan& plan, const Graph& graph) : plan_(plan), state_(plan.resources.size()) {
    collect_inputs(graph.nodes);
    for (size_t i = 0; i < plan.resources.size(); ++i) {
      state_[i].layout = plan.resources[i].initial_layout;
      state_[i].defined = plan.resources[i].constant.has_value();
    }
  }

  void frame() {
    uint32_t segment = 0;
    while (segment < plan_.segments.size()) {
      const LoopPlan* loop = nullptr;
      for (const LoopPlan& candidate : plan_.loops)
        if (candidate.first_segment == segment) loop = &candidate;
      const uint32_t end = loop ? loop->last_segment : segment + 1;
      for (uint32_t turn = 0; turn < (loop ? 3u : 1u); ++turn) {
        if (turn > 0) apply(loop->repeat_barriers, 0);
        for (uint32_t s = segment; s < end; ++s) run(plan_.segments[s], turn);
      }
      segment = end;
    }
    apply(plan_.final_barriers, 0);
    for (const auto& [name, index] : plan_.outputs)
      use(index,
          use_of(Access::transfer_read, PassKind::compute, plan_.resources[index].is_buffer,
                 plan_.resources[index].image.format),
          false, "final " + name);
  }

 private:
  struct State {
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool defined = false;
    std::string value;                  // the port that wrote it last
    VkPipelineStageFlags2 writer = 0;   // stages of the last write
    VkPipelineStageFlags2 waited = 0;   // stages that wait for it
    VkAccessFlags2 visible = 0;         // accesses it is visible to
    VkPipelineStageFlags2 readers = 0;  // stages that read since, and that nothing waited for
  };

  void collect_inputs(const std::vector<GraphNode>& nodes) {
    for (const GraphNode& node : nodes) {
      for (const auto& [port, ref] : node.in) inputs_[node.id + "." + port] = ref;
      collect_inputs(node.body);
    }
  }

  // In the first turn a pass reads the very value that the graph connects (unless that one is left out).
  void check_value(const std::string& input, const std::string& value) {
    const PortRef& ref = inputs_.at(input);
    for (const PlanNode& node : plan_.nodes) {
      if (node.id == ref.node) {
        EXPECT_EQ(value, to_string(ref)) << input;
      }
    }
  }

  void run(const Segment& segment, uint32_t turn) {
    for (uint32_t i = segment.first; i < segment.last; ++i) {
      const PlanNode& node = plan_.nodes[i];
      apply(node.barriers, turn);
      for (const auto& [name, index] : node.resources) {
        const Port& port = *node.declaration.find(name);
        const Resource& resource = plan_.resources[index];
        if (resource.history || port.access == Access::host_read) continue;
        const bool reads = port.direction == Direction::in || port.direction == Direction::inout;
        const std::string what = node.id + "." + name;
        if (reads) {
          EXPECT_TRUE(state_[index].defined) << what << " reads what nobody wrote";
        }
        if (reads && turn == 0 && !resource.constant) check_value(what, state_[index].value);
        use(index, use_of(port.access, node.declaration.kind(), resource.is_buffer, resource.image.format),
            writes(port.access), what);
        if (writes(port.access)) state_[index].value = what;
      }
    }
  }

  void apply(const std::vector<Barrier>& barriers, uint32_t turn) {
    for (const Barrier& barrier : barriers) {
      if (barrier.once && turn > 0) continue;
      if (barrier.previous || plan_.resources[barrier.resource].history) continue;
      State& state = state_[barrier.resource];
      const std::string& name = plan_.resources[barrier.resource].name;
      if (barrier.discard) check_predecessors(barrier);
      if (!barrier.discard) {
        EXPECT_EQ(barrier.before.layout, state.layout) << name;
      }
      const bool changes = barrier.discard || barrier.before.layout != barrier.after.layout;
      const bool chained =
          (state.writer & ~barrier.before.stages) == 0 || (state.waited & barrier.before.stages) != 0;
      const bool readers_done = (state.readers & ~barrier.before.stages) == 0;
      if (!barrier.discard) {
        EXPECT_TRUE(chained) << name;
      }
      if (changes) {
        EXPECT_TRUE(readers_done) << name;
      }
      if (readers_done) state.readers = 0;
      if (changes) state.waited = 0, state.visible = 0, state.writer = barrier.after.stages;
      if (barrier.discard) state.defined = false;
      state.layout = barrier.after.layout;
      state.waited |= barrier.after.stages;
      state.visible |= barrier.after.access;
    }
  }

  // Everything that used this memory before, in this frame or the one before, has to be waited for.
  void check_predecessors(const Barrier& barrier) {
    for (size_t i = 0; i < state_.size(); ++i) {
      const Resource &mine = plan_.resources[barrier.resource], &other = plan_.resources[i];
      const bool same = i == barrier.resource;
      const bool overlaps = mine.size && other.size && mine.offset < other.offset + other.size &&
                            other.offset < mine.offset + mine.size;
      if (!same && !overlaps) continue;
      State& state = state_[i];
      EXPECT_EQ(state.readers & ~barrier.before.stages, 0u)
          << mine.name << " does not wait for readers of " << other.name;
      const bool waited = (state.waited & barrier.before.stages) != 0;
      if (state.defined && state.readers == 0 && !waited) {
        EXPECT_EQ(state.writer & ~barrier.before.stages, 0u) << mine.name << " over " << other.name;
      }
      if (!same) state = State{};  // its contents are gone, and all that used them has been waited for
    }
  }

  void use(uint32_t index, const Use& use, bool write, const std::string& what) {
    State& state = state_[index];
    EXPECT_EQ(state.layout, use.layout) << what;
    if (!plan_.resources[index].constant) {
      EXPECT_EQ(use.stages & ~state.waited, 0u) << what << " does not wait";
      EXPECT_EQ(use.access & ~state.visible, 0u) << what << " does not see";
    }
    if (write) {
      EXPECT_EQ(state.readers, 0u) << what << " writes under a reader";
      state.defined = true;
      state.writer = use.stages;
      state.waited = 0;
      state.visible = 0;
    } else {
      state.readers |= use.stages;
    }
  }

  const Plan& plan_;
  std::vector<State> state_;
  std::map<std::string, PortRef> inputs_;
};

// Sources, filters, blends, scratches, foldings and in-place modifications in random order, and perhaps a
// loop.
std::string random_graph(std::mt19937& random) {
  std::vector<std::string> values{"p0.result"};  // that may still be read
  std::vector<std::string> passes{pass("p0", "t_value")};
  const auto pick = [&] { return values[random() % values.size()]; };
  const auto add = [&](int i) {
    const std::string id = "p" + std::to_string(i);
    std::string result = id + ".result";
    switch (random() % 9) {
      case 0:
        passes.push_back(pass(id, "t_value"));
        break;
      case 1:
        passes.push_back(
            pass(id, "t_blend", from("a", pick()) + "," + from("b", pick()) + "," + from("c", pick())));
        break;
      case 2:
        passes.push_back(pass(id, "t_scratch", source(pick())));
        break;
      case 3:
        passes.push_back(pass(id, "t_constant", source(pick())));
        break;
      case 4: {
        const std::string ref = pick();
        passes.push_back(pass(id, ref.ends_with(".depth") ? "t_filter" : "t_bypass", source(ref)));
        break;
      }
      case 5: {
        const size_t target = random() % values.size();
        const std::string ref = values[target];
        if (values.size() < 2 || ref.ends_with(".depth")) {  // a storage image is no depth image
          passes.push_back(pass(id, "t_value"));
          break;
        }
        values.erase(values.begin() +
                     std::ptrdiff_t(target));  // nobody else may read it later: always orderable
        const bool guided = random() % 2;
        passes.push_back(
            pass(id, "t_modify", from("target", ref) + (guided ? "," + from("guide", pick()) : "")));
        result = id + ".target";
        break;
      }
      case 6:
        passes.push_back(pass(id, "t_source"));
        result = id + ".depth";
        break;
      default:
        passes.push_back(pass(id, "t_filter", source(pick())));
        break;
    }
    values.push_back(result);
  };
  const int before = 1 + int(random() % 10);
  for (int i = 1; i <= before; ++i) add(i);
  if (random() % 2) {
    const size_t start = passes.size();
    passes.push_back(pass("step", "t_step", from("state", "data.data") + "," + from("guide", pick())));
    for (int i = 100; i < 100 + int(random() % 5); ++i) add(i);
    passes.push_back(pass("decide", "t_decide", from("votes", "step.votes") + "," + source(pick())));
    std::string body;
    for (size_t i = start; i < passes.size(); ++i) body += (i > start ? "," : "") + passes[i];
    passes.resize(start);
    passes.push_back(pass("data", "t_buffer"));
    passes.push_back(pass("early", "t_sum", from("data", "data.data")));  // before the loop changes it
    values.push_back("early.result");
    passes.push_back(R"({"id": "again", "type": "loop", "controller": "decide", "max": 4, "passes": [)" +
                     body + "]}");
    passes.push_back(pass("sum", "t_sum", from("data", "step.state")));
    values.push_back("sum.result");
    values.push_back("decide.result");
    for (int i = 200; i < 200 + int(random() % 5); ++i) add(i);
  }
  std::shuffle(passes.begin(), passes.end(), random);
  std::string list;
  for (const std::string& text : passes) list += (list.empty() ? "" : ",") + text;
  return file_with(list, R"({"visibility": ")" + values.back() + R"(", "other": ")" + pick() + R"("})");
}

void expect_no_overlap(const Plan& plan) {
  for (size_t i = 0; i < plan.resources.size(); ++i)
    for (size_t j = i + 1; j < plan.resources.size(); ++j) {
      const Resource &a = plan.resources[i], &b = plan.resources[j];
      const bool together = a.size && b.size && a.first <= b.last && b.first <= a.last;
      if (together) {
        EXPECT_TRUE(a.offset + a.size <= b.offset || b.offset + b.size <= a.offset)
            << a.name << " and " << b.name;
      }
    }
}

TEST_F(CompileTest, RandomGraphsKeepEveryInvariant) {
  std::mt19937 random(3);
  size_t passes = 0, loops = 0, folded = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string text = random_graph(random);
    SCOPED_TRACE(text);
    const Graph graph = parse_graph(text, "g.json");
    for (const bool alias : {true, false}) {
      CompileOptions options;
      options.alias = alias;
      const Plan plan = compile(graph, tiny, facts_with(random() % 2), options);
      expect_no_overlap(plan);
      EXPECT_LE(plan.heap_bytes, plan.heap_bytes_without_aliasing);
      Simulator simulator(plan, graph);
      for (int frame = 0; frame < 3; ++frame) simulator.frame();
      passes += plan.nodes.size();
      loops += plan.loops.size();
      folded += std::any_of(plan.nodes.begin(), plan.nodes.end(),
                            [](const PlanNode& n) { return !n.constant_inputs.empty(); });
    }
    if (HasFailure()) break;
  }
  EXPECT_GT(passes, 10000u);
  EXPECT_GT(loops, 200u);
  EXPECT_GT(folded, 200u);
}

}  // namespace
}  // namespace gnomon
