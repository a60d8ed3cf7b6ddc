// What graphs say of themselves through what their passes declare.
#include "passes/technique.h"

#include <gtest/gtest.h>

#include "engine/graph/graph.h"

namespace gnomon {
namespace {

TEST(Technique, SaysWhatItsShadowsAre) {
  const std::pair<const char*, ShadowKind> kinds[] = {{"shadow_mapping", ShadowKind::hard},
                                                      {"rbsm_nonconservative", ShadowKind::hard},
                                                      {"rbsm_filtered", ShadowKind::filtered},
                                                      {"pcf", ShadowKind::filtered},
                                                      {"msm", ShadowKind::filtered},
                                                      {"edtsm", ShadowKind::filtered},
                                                      {"edtsm_bilateral", ShadowKind::filtered},
                                                      {"area_uniform", ShadowKind::soft},
                                                      {"area_adaptive_rb", ShadowKind::soft},
                                                      {"area_temporal", ShadowKind::soft},
                                                      {"shadow_volumes", ShadowKind::hard},
                                                      {"planar_shadows", ShadowKind::hard},
                                                      {"pcss", ShadowKind::soft},
                                                      {"savsm", ShadowKind::soft},
                                                      {"vssm", ShadowKind::soft},
                                                      {"mssm", ShadowKind::soft},
                                                      {"essm", ShadowKind::soft},
                                                      {"cssm", ShadowKind::soft},
                                                      {"ssrbssm", ShadowKind::soft}};
  for (const auto& [name, kind] : kinds) EXPECT_EQ(shadow_kind(load_graph(find_graph(name))), kind) << name;
}

TEST(Technique, SaysHowWideItsMapsAreAndByWhichVariable) {
  using Names = std::vector<std::string>;
  for (const char* name : {"shadow_mapping", "esm", "area_uniform", "area_adaptive"}) {
    const Graph graph = load_graph(find_graph(name), {{"shadow_map", int64_t{300}}});
    EXPECT_EQ(map_side(graph), 300u) << name;
    EXPECT_EQ(map_side_variables(graph), Names{"shadow_map"}) << name;
  }
  const Graph volumes = load_graph(find_graph("shadow_volumes"));
  EXPECT_EQ(map_side(volumes), std::nullopt);
  EXPECT_TRUE(map_side_variables(volumes).empty());
}

// The names are the graph's own: what counts is which parameter they set.
TEST(Technique, VariablesMayHaveAnyName) {
  const std::string passes = R"("passes": [ { "id": "gbuffer", "type": "gbuffer" },
    { "id": "views", "type": "light_views" },
    { "id": "fine", "type": "shadow_map", "from": "views", "params": { "size": "$texels" } },
    { "id": "coarse", "type": "shadow_map", "from": "views", "params": { "size": 64 } },
    { "id": "test", "type": "shadow_test", "in": { "shadow_map": "fine.depth" }, "from": "gbuffer" } ],
    "outputs": { "visibility": "test.visibility", "map": "coarse.depth" } })";
  const Graph graph =
      parse_graph(R"({ "schema": 1, "name": "own", "vars": { "texels": 200 }, )" + passes, "g.json");
  EXPECT_EQ(map_side(graph), 200u);
  EXPECT_EQ(map_side_variables(graph), std::vector<std::string>{"texels"});
}

TEST(Technique, ReadsHistoryOrNot) {
  EXPECT_TRUE(reads_history(load_graph(find_graph("area_temporal"))));
  EXPECT_FALSE(reads_history(load_graph(find_graph("area_adaptive"))));
}

}  // namespace
}  // namespace gnomon
