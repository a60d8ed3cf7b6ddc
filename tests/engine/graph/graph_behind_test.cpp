// Inputs that connect themselves to what stands behind another input's source.
#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/graph/graph_resolve.h"
#include "engine/plan/compile.h"
#include "tests/engine/plan/fake_passes.h"

namespace gnomon {
namespace {

constexpr ImageShape kMap{{8, 8}, 3, 1, VK_FORMAT_R32_SFLOAT};

struct Fake : Pass {
  void record(Context&) override {}
};

// What the layers of a map are.
struct Places : Fake {
  void declare(Declaration& d) const override {
    const auto count = uint64_t(d.integer("count", 3, 1, 9, "1", "how many"));
    d.output_buffer("places", Access::host_write, {count, 16, "vec4"}, "one a layer");
  }
};
struct Map : Fake {
  void declare(Declaration& d) const override {
    d.input_buffer("places", Access::uniform, "what is shown");
    if (d.flag("tells", true, "whether readers may ask for it")) d.offer_behind("places", "depth");
    d.output("depth", Access::storage_write, true, kMap, "a map");
  }
};
// Another map of the map.
struct Remade : Fake {
  void declare(Declaration& d) const override {
    d.input("map", Access::sampled, true, "a map");
    d.offer_behind("map", "result");
    d.output("result", Access::storage_write, true, kMap, "another map");
  }
};
struct Reader : Fake {
  void declare(Declaration& d) const override {
    d.input("map", Access::sampled, true, "a map");
    d.input_behind("places", "map", Access::uniform, "what the map shows");
    d.output("visibility", Access::storage_write, false, {{8, 8}, 1, 1, VK_FORMAT_R32_SFLOAT}, "the end");
  }
};
struct Casual : Fake {
  void declare(Declaration& d) const override {
    d.input("map", Access::sampled, true, "a map");
    d.optional_input_behind("places", "map", Access::uniform, "what the map shows");
    d.output("visibility", Access::storage_write, false, {{8, 8}, 1, 1, VK_FORMAT_R32_SFLOAT}, "the end");
  }
};

template <class T>
void add(const char* type) {
  PassRegistry::instance().add(type, [] { return std::unique_ptr<Pass>(new T()); });
}

class Behind : public testing::Test {
 protected:
  void SetUp() override {
    add<Places>("t_places"), add<Map>("t_map"), add<Remade>("t_remade"), add<Reader>("t_reader");
    add<Casual>("t_casual");
  }
};

std::string text_of(const std::string& map_params, const std::string& reader, const std::string& source,
                    const std::string& more = "") {
  return R"({"schema": 1, "name": "behind", "passes": [
    {"id": "end", "type": ")" +
         reader + R"(", "in": {"map": ")" + source + "\"" + more + R"(}},
    {"id": "again", "type": "t_remade", "in": {"map": "map.depth"}},
    {"id": "map", "type": "t_map", "in": {"places": "seen.places"}, "params": {)" +
         map_params + R"(}},
    {"id": "seen", "type": "t_places", "params": {"count": 5}}],
    "outputs": {"visibility": "end.visibility"}})";
}

std::string error_of(const std::string& text) {
  try {
    parse_graph(text, "g.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

const ResolvedNode& node_of(const ResolvedGraph& graph, const char* id) {
  return graph.nodes[graph.index.at(id)];
}

TEST_F(Behind, AReaderIsConnectedToWhatTheMapWasMadeWith) {
  for (const char* source : {"map.depth", "again.result"}) {  // carried through what makes another map
    const Graph graph = parse_graph(text_of("", "t_reader", source), "g.json");
    Problems problems;
    const ResolvedGraph resolved = resolve_graph(graph, {}, problems);
    ASSERT_TRUE(problems.empty());
    const ResolvedNode& end = node_of(resolved, "end");
    EXPECT_EQ(end.in.at("places"), (PortKey{resolved.index.at("seen"), "places"}));
    EXPECT_EQ(end.declaration.find("places")->buffer.count, 5u);
  }
}

TEST_F(Behind, ThePlanSeesAnOrdinaryInput) {
  const Graph graph = parse_graph(text_of("", "t_reader", "map.depth"), "g.json");
  const std::string plan = to_text(compile(graph, {}, {}));
  EXPECT_NE(plan.find("host_write"), std::string::npos) << plan;
  EXPECT_NE(plan.find("uniform_read"), std::string::npos) << plan;
  EXPECT_NE(plan.find("host written"), std::string::npos) << plan;
}

TEST_F(Behind, WhoNeedsItSaysSoWhereItIsNot) {
  const std::string error = error_of(text_of(R"("tells": false)", "t_reader", "map.depth"));
  for (const char* part : {"'map.depth' has no 'places' behind it", "'end' (t_reader)", "/passes/0/in/map"})
    EXPECT_NE(error.find(part), std::string::npos) << error;
  EXPECT_EQ(error_of(text_of(R"("tells": false)", "t_casual", "map.depth")), "no error");
}

TEST_F(Behind, ItIsNotConnectedByHand) {
  const std::string error = error_of(text_of("", "t_reader", "map.depth", R"(, "places": "seen.places")"));
  EXPECT_NE(error.find("it comes with 'map'"), std::string::npos) << error;
}

}  // namespace
}  // namespace gnomon
