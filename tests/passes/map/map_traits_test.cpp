// What shadow maps say of themselves reaches their readers, and wrong combinations are errors at load.
#include "passes/map/map_traits.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/graph/graph_resolve.h"

namespace gnomon {
namespace {

Params params_of(const Graph& graph, const std::string& id) {
  Problems problems;
  const ResolvedGraph resolved = resolve_graph(graph, {}, problems);
  problems.raise();
  return resolved.nodes[resolved.index.at(id)].declaration.params();
}

TEST(MapTraits, ReadersTakeEncodingAndBiasFromTheMap) {
  const Graph graph = load_graph(find_graph("shadow_mapping"),
                                 {{"depth", std::string("linear")}, {"bias", std::string("constant")}});
  const Params test = params_of(graph, "test"), map = params_of(graph, "map");
  EXPECT_EQ(test.choice("encoding"), "linear");
  EXPECT_EQ(test.choice("bias"), "constant");
  for (const char* name : {"bias_constant", "bias_slope", "bias_normal"})
    EXPECT_EQ(test.number(name), map.number(name)) << name;
  EXPECT_EQ(test.number("bias_constant"), 8.0);
}

TEST(MapTraits, MomentsSayTheirBasisAndTheFilterItsKernel) {
  const Graph graph = load_graph(find_graph("esm"), {{"exponent", 33.5},
                                                     {"space", std::string("log")},
                                                     {"kernel", int64_t{7}},
                                                     {"depth", std::string("linear")}});
  const Params filter = params_of(graph, "filter"), test = params_of(graph, "test");
  EXPECT_EQ(filter.choice("space"), "log");
  EXPECT_EQ(filter.number("exponent"), 33.5);
  EXPECT_EQ(test.choice("basis"), "exponential");
  EXPECT_EQ(test.choice("space"), "log");
  EXPECT_EQ(test.number("exponent"), 33.5);
  EXPECT_EQ(test.integer("kernel"), 7);
  EXPECT_EQ(test.choice("encoding"), "linear");
  EXPECT_EQ(params_of(graph, "moments").choice("encoding"), "linear");
}

struct Wrong {
  const char* name;
  const char* passes;               // after the G-buffer and two maps
  std::vector<const char*> pieces;  // of the message
};

std::string error_of(const Wrong& wrong) {
  const std::string text =
      R"({ "schema": 1, "name": "wrong", "passes": [ { "id": "gbuffer", "type": "gbuffer" },
    { "id": "views", "type": "light_views" }, { "id": "map", "type": "shadow_map", "from": "views" },
    { "id": "other", "type": "shadow_map", "from": "views", "params": { "encoding": "linear" } },
    { "id": "moments", "type": "shadow_moments", "in": { "shadow_map": "map.depth" } },)" +
      std::string(wrong.passes) + R"(], "outputs": { "result": "end.)" +
      (std::string(wrong.name) == "filter" ? "result" : "visibility") + R"(" } })";
  try {
    parse_graph(text, "g.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MapTraits, WrongCombinationsAreErrorsThatNameBothNodes) {
  const Wrong all[] = {
      {"moment test",
       R"({ "id": "end", "type": "moment_test", "in": { "depth": "gbuffer.depth",
         "geometric": "gbuffer.geometric", "shadow_map": "map.depth", "moments": "map.depth" } })",
       {"/passes/5/in/moments", "'end' (moment_test) cannot read 'depth' of 'map' (shadow_map)",
        "holds depth, and not a transform of it", "'map' is at /passes/2"}},
      {"another map",
       R"({ "id": "end", "type": "moment_test", "in": { "depth": "gbuffer.depth",
         "geometric": "gbuffer.geometric", "shadow_map": "other.depth", "moments": "moments.moments" } })",
       {"'end' (moment_test) cannot read 'moments' of 'moments' (shadow_moments)",
        "its encoding is perspective, not linear"}},
      {"hard test of moments",
       R"({ "id": "end", "type": "shadow_test", "in": { "depth": "gbuffer.depth",
         "geometric": "gbuffer.geometric", "shadow_map": "moments.moments" } })",
       {"/passes/5/in/shadow_map", "'end' (shadow_test) cannot read 'moments' of 'moments' (shadow_moments)",
        "not depth"}},
      {"no map",
       R"({ "id": "end", "type": "pcf", "in": { "depth": "gbuffer.depth",
         "geometric": "gbuffer.geometric", "shadow_map": "gbuffer.depth" } })",
       {"'end' (pcf) cannot read 'depth' of 'gbuffer' (gbuffer)", "is no map of depth from the light"}},
      {"filter",
       R"({ "id": "end", "type": "prefilter", "in": { "source": "other.depth" } })",
       {"'end' (prefilter) cannot read 'depth' of 'other' (shadow_map)", "whose average is no depth"}},
  };
  for (const Wrong& wrong : all) {
    const std::string error = error_of(wrong);
    for (const char* piece : wrong.pieces)
      EXPECT_NE(error.find(piece), std::string::npos) << wrong.name << ": " << piece << "\n" << error;
  }
}

}  // namespace
}  // namespace gnomon
