// Shorthands of graph files: "from" connects inputs by their names, "vars" sets parameters by theirs.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/graph/graph_resolve.h"
#include "tests/engine/plan/fake_passes.h"

namespace gnomon {
namespace {

class Shorthand : public testing::Test {
 protected:
  void SetUp() override { test::register_fake_passes(); }
};

std::string file_with(const std::string& passes, const std::string& output, const std::string& more = "") {
  return R"({"schema": 1, "name": "x", )" + more + R"("passes": [)" + passes +
         R"(], "outputs": {"visibility": ")" + output + R"("}})";
}

std::string error_of(const std::string& text) {
  try {
    parse_graph(text, "g.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void expect_error(const std::string& text, std::initializer_list<const char*> pieces) {
  const std::string error = error_of(text);
  for (const char* piece : pieces) EXPECT_NE(error.find(piece), std::string::npos) << piece << "\n" << error;
}

// "a.result", of each input of a node.
std::map<std::string, std::string> inputs_of(const Graph& graph, const std::string& id) {
  Problems problems;
  const ResolvedGraph resolved = resolve_graph(graph, {}, problems);
  problems.raise();
  std::map<std::string, std::string> inputs;
  for (const auto& [input, source] : resolved.nodes[resolved.index.at(id)].in)
    inputs[input] = resolved.nodes[source.node].node->id + "." + source.port;
  return inputs;
}
using Inputs = std::map<std::string, std::string>;

const std::string step =
    R"({"id": "data", "type": "t_buffer"}, {"id": "step", "type": "t_step", "in": {"state": "data.data"}}, )";

TEST_F(Shorthand, FromConnectsInputsToOutputsOfTheSameNames) {
  const std::string text =
      file_with(step + R"({"id": "end", "type": "t_decide", "from": "step"})", "end.result");
  const Graph graph = parse_graph(text, "g.json");
  EXPECT_EQ(inputs_of(graph, "end"), (Inputs{{"votes", "step.votes"}}));
  EXPECT_TRUE(graph.nodes[2].in.empty()) << "what the file says stays apart from what follows of it";
}

TEST_F(Shorthand, FromMayListSeveralAndOptionalInputsCount) {
  const std::string text = file_with(
      step + R"({"id": "says", "type": "t_target"}, {"id": "m", "type": "t_modify", "from": ["says"]})",
      "m.target");
  EXPECT_EQ(inputs_of(parse_graph(text, "g.json"), "m"),
            (Inputs{{"guide", "says.guide"}, {"target", "says.target"}}));
}

TEST_F(Shorthand, WhatIsNamedComesFirst) {
  const std::string text = file_with(
      R"({"id": "v", "type": "t_value"}, {"id": "says", "type": "t_target"},
         {"id": "m", "type": "t_modify", "in": {"guide": "v.result"}, "from": "says"})",
      "m.target");
  EXPECT_EQ(inputs_of(parse_graph(text, "g.json"), "m"),
            (Inputs{{"guide", "v.result"}, {"target", "says.target"}}));
}

TEST_F(Shorthand, FromOrdersPasses) {
  const std::string text =
      file_with(R"({"id": "end", "type": "t_modify", "from": "says"}, {"id": "says", "type": "t_target"})",
                "end.target");
  Problems problems;
  const Graph graph = parse_graph(text, "g.json");
  EXPECT_EQ(resolve_graph(graph, {}, problems).order, (std::vector<uint32_t>{1, 0}));
}

TEST_F(Shorthand, FromIsWrittenBack) {
  const std::string text =
      file_with(step + R"({"id": "end", "type": "t_decide", "from": ["step"]})", "end.result");
  const nlohmann::json once = to_json(parse_graph(text, "g.json"));
  EXPECT_EQ(once["passes"][2]["from"], nlohmann::json::array({"step"}));
  EXPECT_EQ(to_json(parse_graph(once.dump(), "h.json")), once);
}

TEST_F(Shorthand, FromThatCannotBeMeantIsAnError) {
  const std::string two = R"({"id": "a", "type": "t_target"}, {"id": "b", "type": "t_target"}, )";
  expect_error(file_with(two + R"({"id": "m", "type": "t_modify", "from": ["a", "b"]})", "m.target"),
               {"/passes/2/from", "input 'target' of 'm' (t_modify) may be any of", "a.target", "b.target",
                "under \"in\""});
  expect_error(file_with(R"({"id": "a", "type": "t_value"}, {"id": "m", "type": "t_modify", "from": "a"})",
                         "m.target"),
               {"/passes/1/from", "'a' (t_value) gives 'm' (t_modify) nothing",
                "required input 'target' of 't_modify' is not connected"});
  expect_error(
      file_with(R"({"id": "alpha", "type": "t_target"}, {"id": "m", "type": "t_modify", "from": "alpa"})",
                "m.target"),
      {"/passes/1/from", "unknown pass 'alpa'", "alpha"});
  expect_error(file_with(R"({"id": "m", "type": "t_modify", "from": "m"})", "m.target"),
               {"a cycle", "'m' -> 'm'"});
  expect_error(
      file_with(R"({"id": "a", "type": "t_target"}, {"id": "m", "type": "t_modify", "from": 3})", "m.target"),
      {"/passes/1/from", "must be a name"});
  expect_error(
      file_with(R"({"id": "a", "type": "t_target"}, {"id": "m", "type": "t_modify", "from": ["a", "a"]})",
                "m.target"),
      {"/passes/1/from", "names 'a' twice"});
}

const std::string width_and_mode = R"("vars": {"width": 5, "mode": "tent"}, )";

TEST_F(Shorthand, VarsSetParametersOfTheSameNames) {
  const Graph graph = parse_graph(file_with(R"({"id": "v", "type": "t_value"},
                   {"id": "f", "type": "t_filter", "in": {"source": "v.result"}, "vars": ["width", "mode"]})",
                                            "f.result", width_and_mode),
                                  "g.json", {{"width", int64_t{7}}});
  EXPECT_EQ(graph.nodes[1].params, (Values{{"mode", std::string("tent")}, {"width", int64_t{7}}}));
  EXPECT_EQ(graph.nodes[1].variables, (Inputs{{"mode", "mode"}, {"width", "width"}}));
}

TEST_F(Shorthand, VarsThatDoNotFitAreErrors) {
  const auto with = [](const std::string& more, const std::string& vars = width_and_mode) {
    return file_with(R"({"id": "v", "type": "t_value"},
                        {"id": "f", "type": "t_filter", "in": {"source": "v.result"}, )" +
                         more + "}",
                     "f.result", vars);
  };
  expect_error(with(R"("vars": ["width", "mood"])"), {"/passes/1/vars", "unknown variable 'mood'", "mode"});
  expect_error(with(R"("params": {"width": "$width"}, "vars": ["width", "mode"])"),
               {"/passes/1/vars", "parameter 'width' is set twice"});
  expect_error(with(R"("vars": ["wide"])", R"("vars": {"wide": 5}, )"),
               {"/passes/1/vars", "unknown parameter 'wide' of 't_filter'"});
  expect_error(with(R"("vars": "width")", R"("vars": {"width": 99}, )"),
               {"/passes/1/vars", "'width' is 99: must be in 1..31 texels"});
}

}  // namespace
}  // namespace gnomon
