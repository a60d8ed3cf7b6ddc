// Plans that need more than --memory are refused, with what takes how much; what divides its work is not.
#include "engine/plan/memory_limit.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "tests/engine/plan/fake_passes.h"

namespace gnomon {
namespace {

constexpr uint64_t kImage = 64 * 64 * 4;  // bytes of one R32_SFLOAT image of the viewport

Graph graph_of(const std::string& passes) {
  test::register_fake_passes();
  return parse_graph(
      R"({"schema": 1, "name": "x", "outputs": {"visibility": "end.result"}, "passes": [)" + passes + "]}",
      "g.json");
}

// The problem, or nothing.
std::string problem(const Graph& graph, uint64_t memory) {
  Declaration::Setting setting{{64, 64}, 1};
  setting.memory = memory;
  SceneFacts facts;
  facts.triangles = 1;
  try {
    check_memory(compile(graph, setting, facts), graph, setting, facts, {});
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(MemoryLimit, WhatTheWholePlanTakesCounts) {
  // Three images: two at a time in the heap or one there beside the exported one.
  const Graph graph = graph_of(R"({"id": "a", "type": "t_value"},
    {"id": "b", "type": "t_filter", "in": {"source": "a.result"}},
    {"id": "end", "type": "t_filter", "in": {"source": "b.result"}})");
  EXPECT_EQ(problem(graph, 3 * kImage), "");
  const std::string text = problem(graph, 3 * kImage - 1);
  EXPECT_NE(text.find("g.json: it needs 0.0469 MB of memory"), std::string::npos) << text;
  EXPECT_NE(text.find("a.result 0.0156 MB, b.result 0.0156 MB, end.result 0.0156 MB"), std::string::npos)
      << text;
  EXPECT_NE(text.find("--memory 1GB allows it"), std::string::npos) << text;
}

TEST(MemoryLimit, HistoryCountsTwice) {
  const Graph graph = graph_of(R"({"id": "a", "type": "t_value"},
    {"id": "end", "type": "t_history", "in": {"source": "a.result", "last": "end.result@previous"}})");
  EXPECT_EQ(problem(graph, 3 * kImage), "");
  EXPECT_NE(problem(graph, 3 * kImage - 1), "");
}

// The transient grows to the limit, beside which the exported image still is.
TEST(MemoryLimit, WhatDividesItsWorkCountsWithTheLeastItCanDoWith) {
  const Graph graph = graph_of(R"({"id": "end", "type": "t_batches"})");
  EXPECT_EQ(problem(graph, 16 * kImage), "");
  EXPECT_EQ(problem(graph, 2 * kImage), "");
  EXPECT_NE(problem(graph, 2 * kImage - 1), "");
}

}  // namespace
}  // namespace gnomon
