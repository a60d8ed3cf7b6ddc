// What producers say of their outputs reaches those who read them, and nothing else can say it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/graph/graph_resolve.h"
#include "engine/render/preamble.h"
#include "tests/engine/plan/fake_passes.h"

namespace gnomon {
namespace {

class Traits : public testing::Test {
 protected:
  void SetUp() override { test::register_fake_passes(); }
};

std::string file_with(const std::string& passes, const std::string& output) {
  return R"({"schema": 1, "name": "x", "passes": [)" + passes + R"(], "outputs": {"visibility": ")" + output +
         R"("}})";
}

const std::string says = R"({"id": "says", "type": "t_says", "params": {"tone": "cold"}}, )";
const std::string carries = R"({"id": "mid", "type": "t_carries", "in": {"source": "says.result"}}, )";

std::string asks(const std::string& source, const std::string& more = "") {
  return R"({"id": "asks", "type": "t_asks", "in": {"source": ")" + source + R"("})" + more + "}";
}

std::string error_of(const std::string& text) {
  try {
    parse_graph(text, "g.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

Declaration declaration_of(const Graph& graph, const std::string& id) {
  Problems problems;
  const ResolvedGraph resolved = resolve_graph(graph, {}, problems);
  problems.raise();
  return resolved.nodes[resolved.index.at(id)].declaration;
}

TEST_F(Traits, ReachTheReaderAndItsShaders) {
  const Graph graph = parse_graph(
      file_with(asks("says.result") + ", " + says.substr(0, says.size() - 2), "asks.result"), "g.json");
  const Params params = declaration_of(graph, "asks").params();
  EXPECT_EQ(params.choice("tone"), "cold");
  const Defines defines = parameter_defines(params);
  EXPECT_NE(std::find(defines.begin(), defines.end(), std::pair<std::string, std::string>("TONE", "1")),
            defines.end());
}

TEST_F(Traits, AreCarriedOn) {
  const Graph graph = parse_graph(file_with(says + carries + asks("mid.result"), "asks.result"), "g.json");
  EXPECT_EQ(declaration_of(graph, "asks").params().choice("tone"), "cold");
  const Declaration carrier = declaration_of(graph, "mid");
  EXPECT_EQ(carrier.find("result")->traits,
            (Values{{"filtered", true}, {"parts", int64_t{3}}, {"tone", std::string("cold")}}));
}

// What is modified in place keeps what was said of it.
TEST_F(Traits, StayWithWhatIsModified) {
  const Graph graph =
      parse_graph(file_with(says + R"({"id": "mod", "type": "t_modify", "in": {"target": "says.result"}}, )" +
                                asks("mod.target"),
                            "asks.result"),
                  "g.json");
  EXPECT_EQ(declaration_of(graph, "asks").params().choice("tone"), "cold");
}

TEST_F(Traits, CannotBeSetByAReadersParameters) {
  const std::string error =
      error_of(file_with(says + asks("says.result", R"(, "params": {"tone": "warm"})"), "asks.result"));
  EXPECT_NE(
      error.find("/passes/1/params/tone: 'tone' of 't_asks' is not set here: it comes with input 'source'"),
      std::string::npos)
      << error;
}

TEST_F(Traits, ASourceThatDoesNotFitIsRefusedWithBothNodes) {
  const std::string error =
      error_of(file_with(R"({"id": "plain", "type": "t_value"}, )" + asks("plain.result"), "asks.result"));
  for (const char* piece :
       {"/passes/1/in/source: ", "'asks' (t_asks) cannot read 'result' of 'plain' (t_value)",
        "it has no tone", "'plain' is at /passes/0"})
    EXPECT_NE(error.find(piece), std::string::npos) << error;
}

TEST_F(Traits, AreNoParametersInTheSchema) {
  const std::string schema = graph_schema().dump();
  const size_t rule = schema.find("\"const\":\"t_asks\"");
  ASSERT_NE(rule, std::string::npos);
  const size_t from = schema.rfind("{\"if\"", rule), next = schema.find("{\"if\"", rule);
  const std::string of_asks = schema.substr(from, next - from);
  EXPECT_NE(of_asks.find("\"width\""), std::string::npos);
  EXPECT_EQ(of_asks.find("\"tone\""), std::string::npos);
}

TEST_F(Traits, APassMustDeclareWhatItSpeaksOf) {
  Declaration d;
  EXPECT_THROW(d.set_trait("nothing", "tone", true), Error);
  EXPECT_THROW(d.carry_traits("nothing", "nothing"), Error);
  EXPECT_THROW(static_cast<void>(d.trait("nothing", "tone")), Error);
  d.input("source", Access::sampled, false, "source");
  EXPECT_EQ(d.trait("source", "tone"), nullptr);
  d.flag("tone", true, "a parameter");
  EXPECT_THROW(d.derived("source", {"tone", ParamType::flag, true, 0, 1, {}, {}, "twice"}), Error);
}

}  // namespace
}  // namespace gnomon
