// Graph files: every mistake with its place, orders, variables, the schema.
#include "engine/graph/graph.h"
#include "engine/base/resource_root.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "engine/base/error.h"
#include "tests/engine/plan/fake_passes.h"

namespace gnomon {
namespace {

using nlohmann::json;

class GraphTest : public testing::Test {
 protected:
  void SetUp() override { test::register_fake_passes(); }
};

// A whole file around a list of passes.
std::string file_with(const std::string& passes, const std::string& outputs = R"({"visibility": "a.result"})",
                      const std::string& more = "") {
  return R"({"schema": 1, "name": "x", )" + more + R"("passes": [)" + passes + R"(], "outputs": )" + outputs +
         "}";
}

std::string error_of(const std::string& text, const Values& set = {}) {
  try {
    parse_graph(text, "g.json", set);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

const std::string value_a = R"({"id": "a", "type": "t_value"})";

const std::string full_graph = R"({
  "schema": 1, "name": "full", "cite": "a paper", "comment": ["what", "ever"],
  "vars": {"width": 5, "mode": "tent", "turns": 8},
  "passes": [
    // file order is not execution order
    {"id": "end", "type": "t_blend", "in": {"a": "one.result", "b": "sum.result"}},
    {"id": "draw", "type": "t_source"},
    {"id": "one", "type": "t_filter", "in": {"source": "draw.depth"}, "params": {"width": "$width", "mode": "$mode", "clamp": false, "scale": 1.5}},
    {"id": "data", "type": "t_buffer"},
    {"id": "again", "type": "loop", "controller": "decide", "max": "$turns", "passes": [
      {"id": "step", "type": "t_step", "in": {"state": "data.data", "guide": "one.result"}},
      {"id": "decide", "type": "t_decide", "in": {"votes": "step.votes"}}]},
    {"id": "sum", "type": "t_sum", "in": {"data": "step.state"}}],
  "outputs": {"visibility": "end.result"}})";

TEST_F(GraphTest, ReadsEverything) {
  const Graph graph = parse_graph(full_graph, "g.json", {{"width", int64_t{7}}});
  EXPECT_EQ(graph.name, "full");
  EXPECT_EQ(graph.cite, "a paper");
  ASSERT_EQ(graph.nodes.size(), 6u);
  EXPECT_EQ(graph.nodes[2].params.at("width"), Value(int64_t{7}));
  EXPECT_EQ(graph.nodes[2].params.at("mode"), Value(std::string("tent")));
  EXPECT_EQ(graph.nodes[2].params.at("clamp"), Value(false));
  EXPECT_EQ(graph.nodes[2].in.at("source"), (PortRef{"draw", "depth", false}));
  EXPECT_EQ(graph.nodes[4].body.size(), 2u);
  EXPECT_EQ(graph.nodes[4].max, 8u);
  EXPECT_EQ(graph.nodes[4].body[1].place, "/passes/4/passes/1");
  EXPECT_EQ(graph.vars.at("width"), Value(int64_t{7}));
  EXPECT_EQ(graph.outputs.at("visibility"), (PortRef{"end", "result", false}));
}

TEST_F(GraphTest, RoundTrip) {
  const Graph graph = parse_graph(full_graph, "g.json");
  const json once = to_json(graph);
  const Graph again = parse_graph(once.dump(), "h.json");
  EXPECT_EQ(to_json(again), once);
  EXPECT_EQ(again.nodes[2].params, graph.nodes[2].params);
  EXPECT_EQ(again.nodes[4].max, 8u);
}

TEST_F(GraphTest, HistoryMayReadItself) {
  const std::string text = file_with(
      value_a +
          R"(, {"id": "h", "type": "t_history", "in": {"source": "a.result", "last": "h.result@previous"}})",
      R"({"visibility": "h.result"})");
  const Graph graph = parse_graph(text, "g.json");
  EXPECT_TRUE(graph.nodes[1].in.at("last").previous);
  EXPECT_EQ(to_string(graph.nodes[1].in.at("last")), "h.result@previous");
}

struct Bad {
  const char* name;
  std::string text;
  std::vector<std::string> pieces;  // each a part of the message
};

std::string filter(const std::string& more) {
  return value_a + R"(, {"id": "f", "type": "t_filter", )" + more + "}";
}

std::vector<Bad> bad_graphs() {
  const std::string source = R"("in": {"source": "a.result"})";
  return {
      {"not an object", "[]", {"g.json: is an array: must be an object"}},
      {"no members",
       "{}",
       {"'schema' is missing (add \"schema\": 1)", "'name' is missing", "/passes: 'passes' is missing",
        "/outputs: 'outputs' is missing"}},
      {"schema",
       R"({"schema": 2, "name": "x", "passes": [], "outputs": {}})",
       {"/schema: 'schema' is 2: must be 1", "/passes: there are no passes",
        "/outputs: the graph has no outputs"}},
      {"schema type", file_with(value_a).replace(11, 1, "\"1\""), {"/schema: 'schema' is \"1\": must be 1"}},
      {"unknown key",
       file_with(value_a, R"({"v": "a.result"})", R"("output": 3, )"),
       {"/output: unknown key 'output' (did you mean 'outputs'?)"}},
      {"unknown pass key",
       file_with(R"({"id": "a", "type": "t_value", "param": {}})"),
       {"/passes/0/param: unknown key 'param' (did you mean 'params'?)"}},
      {"duplicate key",
       file_with(R"({"id": "a", "type": "t_value", "id": "b"})"),
       {"/passes/0/id: duplicate key 'id'"}},
      {"duplicate id",
       file_with(value_a + "," + value_a),
       {"/passes/1/id: duplicate id 'a' (first at /passes/0)"}},
      {"bad id",
       file_with(value_a + R"(, {"id": "a.b", "type": "t_value"})"),
       {"/passes/1/id: id 'a.b' is not a name"}},
      {"unknown type",
       file_with(R"({"id": "a", "type": "t_valeu"})"),
       {"/passes/0/type: unknown pass type 't_valeu' (did you mean 't_value'?)"}},
      {"no type", file_with(R"({"id": "a"})"), {"/passes/0: 'type' is missing"}},
      {"pass is no object", file_with("3"), {"/passes/0: is 3: must be an object"}},
      {"passes is no array",
       R"({"schema": 1, "name": "x", "passes": {}, "outputs": {"v": "a.b"}})",
       {"/passes: is an object: must be an array"}},
      {"unknown input",
       file_with(filter(R"("in": {"sorce": "a.result"})")),
       {"/passes/1/in/sorce: unknown input 'sorce' of 't_filter' (did you mean 'source'?)",
        "/passes/1/in: required input 'source' of 't_filter' is not connected"}},
      {"missing input",
       file_with(filter(R"("params": {})")),
       {"/passes/1/in: required input 'source' of 't_filter' is not connected"}},
      {"unknown pass in ref",
       file_with(filter(R"("in": {"source": "b.result"})")),
       {"/passes/1/in/source: unknown pass 'b'"}},
      {"unknown port in ref",
       file_with(filter(R"("in": {"source": "a.resutl"})")),
       {"/passes/1/in/source: unknown output 'resutl' of 'a' (t_value) (did you mean 'result'?)"}},
      {"reads an input",
       file_with(filter(source) + R"(, {"id": "g", "type": "t_filter", "in": {"source": "f.source"}})"),
       {"/passes/2/in/source: 'source' is an input of 'f' (t_filter), not an output (one of: result)"}},
      {"connects an output",
       file_with(filter(R"("in": {"source": "a.result", "result": "a.result"})")),
       {"/passes/1/in/result: 'result' is an output of 't_filter', not an input"}},
      {"internal",
       file_with(
           value_a +
           R"(, {"id": "s", "type": "t_scratch", "in": {"source": "a.result"}}, {"id": "f", "type": "t_filter", "in": {"source": "s.rows"}})"),
       {"/passes/2/in/source: 'rows' is internal to 's' (t_scratch)"}},
      {"not a ref",
       file_with(filter(R"("in": {"source": "a"})")),
       {"/passes/1/in/source: is \"a\": must name a port (write \"pass.port\""}},
      {"ref is a number",
       file_with(filter(R"("in": {"source": 3})")),
       {"/passes/1/in/source: is 3: must name a port"}},
      {"in is no object",
       file_with(filter(R"("in": [1])")),
       {"/passes/1/in: is an array: must be an object"}},
      {"unknown parameter",
       file_with(filter(source + R"(, "params": {"wdth": 3})")),
       {"/passes/1/params/wdth: unknown parameter 'wdth' of 't_filter' (did you mean 'width'?)"}},
      {"out of range",
       file_with(filter(source + R"(, "params": {"width": 32, "scale": 0.4})")),
       {"/passes/1/params/width: 'width' is 32: must be in 1..31 texels",
        "/passes/1/params/scale: 'scale' is 0.4: must be in 0.5..2 world units"}},
      {"mistyped",
       file_with(filter(source + R"(, "params": {"width": "3", "mode": "bx", "clamp": 1})")),
       {"'width' is \"3\": must be an integer in 1..31 texels",
        "/passes/1/params/mode: 'mode' is \"bx\": must be one of \"box\", \"tent\", \"gauss\"",
        "/passes/1/params/clamp: 'clamp' is 1: must be true or false"}},
      {"parameter is an array",
       file_with(filter(source + R"(, "params": {"width": [3]})")),
       {"/passes/1/params/width: is an array: must be true, false, a number or a string"}},
      {"unused variable",
       file_with(value_a, R"({"v": "a.result"})", R"("vars": {"w": 1}, )"),
       {"/vars/w: variable 'w' is never used"}},
      {"unknown variable",
       file_with(filter(source + R"(, "params": {"width": "$wdth"})"), R"({"v": "a.result"})",
                 R"("vars": {"width": 1}, )"),
       {"/passes/1/params/width: unknown variable 'wdth' (did you mean 'width'?)"}},
      {"variable out of range",
       file_with(filter(source + R"(, "params": {"width": "$w"})"), R"({"v": "f.result"})",
                 R"("vars": {"w": 99}, )"),
       {"/passes/1/params/width: 'width' is 99: must be in 1..31 texels"}},
      {"variable is null",
       file_with(value_a, R"({"v": "a.result"})", R"("vars": {"w": null}, )"),
       {"/vars/w: is null: must be true, false, a number or a string"}},
      {"cycle",
       file_with(
           R"({"id": "a", "type": "t_filter", "in": {"source": "b.result"}}, {"id": "b", "type": "t_filter", "in": {"source": "c.result"}}, {"id": "c", "type": "t_filter", "in": {"source": "a.result"}})"),
       {"/passes/0: a cycle: 'a' -> 'c' -> 'b' -> 'a'"}},
      {"self cycle",
       file_with(R"({"id": "a", "type": "t_filter", "in": {"source": "a.result"}})"),
       {"a cycle: 'a' -> 'a'"}},
      {"cycle and more",
       file_with(
           R"({"id": "a", "type": "t_filter", "in": {"source": "b.result"}, "params": {"w": 1}}, {"id": "b", "type": "t_filter", "in": {"source": "a.result"}})"),
       {"a cycle: 'a' -> 'b' -> 'a'", "/passes/0/params/w: unknown parameter 'w'"}},
      {"image for a buffer",
       file_with(value_a + R"(, {"id": "s", "type": "t_sum", "in": {"data": "a.result"}})"),
       {"/passes/1/in/data: 'a.result' is an image, and 'data' takes a buffer"}},
      {"buffer for an image",
       file_with(
           value_a +
           R"(, {"id": "d", "type": "t_buffer"}, {"id": "f", "type": "t_filter", "in": {"source": "d.data"}})"),
       {"/passes/2/in/source: 'd.data' is a buffer, and 'source' takes an image"}},
      {"not host-readable",
       file_with(
           value_a +
           R"(, {"id": "d", "type": "t_buffer"}, {"id": "h", "type": "t_host", "in": {"count": "d.data"}})"),
       {"/passes/2/in/count: 'count' is read by the host, and 'd.data' is not host-readable"}},
      {"two modifiers",
       file_with(
           value_a +
               R"(, {"id": "m", "type": "t_modify", "in": {"target": "a.result"}}, {"id": "n", "type": "t_modify", "in": {"target": "a.result"}})",
           R"({"v": "m.target"})"),
       {"/passes/2: 'm' and 'n' both modify 'a.result' in place"}},
      {"reads and modifies",
       file_with(
           value_a +
               R"(, {"id": "m", "type": "t_modify", "in": {"target": "a.result", "guide": "a.result"}})",
           R"({"v": "m.target"})"),
       {"'m' reads 'a.result' and modifies it in place at once"}},
      {"impossible order",
       file_with(
           value_a +
               R"(, {"id": "m", "type": "t_modify", "in": {"target": "a.result"}}, {"id": "b", "type": "t_blend", "in": {"a": "a.result", "b": "m.target"}})",
           R"({"v": "b.result"})"),
       {"no order in which every reader", "'m' -> 'b' -> 'm'"}},
      {"output modified",
       file_with(value_a + R"(, {"id": "m", "type": "t_modify", "in": {"target": "a.result"}})"),
       {"/outputs/visibility: 'a.result' is modified in place by 'm' (name what 'm' gives out)"}},
      {"history modified",
       file_with(
           value_a +
               R"(, {"id": "m", "type": "t_modify", "in": {"target": "a.result", "guide": "a.result@previous"}})",
           R"({"v": "m.target"})"),
       {"'a.result' is read as history, but 'm' modifies it in place"}},
      {"history into inout",
       file_with(value_a + R"(, {"id": "m", "type": "t_modify", "in": {"target": "a.result@previous"}})"),
       {"/passes/1/in/target: 'target' is modified in place and cannot be history"}},
      {"unknown output",
       file_with(value_a, R"({"v": "b.result", "w": "a.x", "x": "a.result@previous", "y": 3})"),
       {"/outputs/v: unknown pass 'b'", "/outputs/w: unknown output 'x' of 'a' (t_value)",
        "/outputs/x: an output cannot be history", "/outputs/y: is 3: must name a port"}},
      {"loop controller",
       file_with(
           value_a +
           R"(, {"id": "l", "type": "loop", "controller": "a", "max": 3, "passes": [{"id": "b", "type": "t_value"}]})"),
       {"/passes/1/controller: controller 'a' is not a pass of the loop's body (one of: b)"}},
      {"loop max",
       file_with(
           value_a +
           R"(, {"id": "l", "type": "loop", "controller": "b", "max": 0, "passes": [{"id": "b", "type": "t_value"}]})"),
       {"/passes/1/max: 'max' is 0: must be an integer in 1..65536 iterations"}},
      {"loop in loop",
       file_with(
           value_a +
           R"(, {"id": "l", "type": "loop", "controller": "b", "max": 2, "passes": [{"id": "b", "type": "t_value"}, {"id": "k", "type": "loop", "controller": "b", "max": 2, "passes": []}]})"),
       {"/passes/1/passes/1: a loop inside a loop"}},
      {"loop parts missing",
       file_with(value_a + R"(, {"id": "l", "type": "loop"})"),
       {"/passes/1: 'controller' is missing", "/passes/1/max: 'max' is missing",
        "/passes/1/passes: 'passes' is missing"}},
      {"reads a loop",
       file_with(
           filter(R"("in": {"source": "l.result"})") +
           R"(, {"id": "l", "type": "loop", "controller": "b", "max": 2, "passes": [{"id": "b", "type": "t_value"}]})"),
       {"/passes/1/in/source: 'l' is a loop, which has no ports"}},
      {"cycle through a loop",
       file_with(
           R"({"id": "a", "type": "t_filter", "in": {"source": "b.result"}}, {"id": "l", "type": "loop", "controller": "b", "max": 2, "passes": [{"id": "b", "type": "t_value"}, {"id": "c", "type": "t_filter", "in": {"source": "a.result"}}]})"),
       {"a cycle: 'a' -> 'b' -> 'a'"}},
      {"no size",
       file_with(R"({"id": "a", "type": "t_huge", "params": {"side": 0}})"),
       {"/passes/0: port 'result' of 't_huge' has a size of 0"}},
  };
}

TEST_F(GraphTest, BadGraphsAreNamedWithTheirPlace) {
  for (const Bad& bad : bad_graphs()) {
    const std::string message = error_of(bad.text);
    for (const std::string& piece : bad.pieces)
      EXPECT_NE(message.find(piece), std::string::npos) << bad.name << "\nwanted: " << piece << "\ngot:\n"
                                                        << message;
    EXPECT_TRUE(message.starts_with("g.json: ")) << bad.name << "\n" << message;
  }
}

// Nothing is reported that the pieces do not name.
TEST_F(GraphTest, OneMistakeIsOneProblem) {
  for (const Bad& bad : bad_graphs()) {
    const std::string message = error_of(bad.text);
    const auto lines = size_t(std::count(message.begin(), message.end(), '\n')) + 1;
    EXPECT_LE(lines, bad.pieces.size() + (std::string(bad.name) == "impossible order" ? 0 : 1))
        << bad.name << "\n"
        << message;
  }
}

TEST_F(GraphTest, UnknownVariableSet) {
  EXPECT_EQ(error_of(full_graph, {{"widht", int64_t{1}}}),
            "g.json: /vars: unknown variable 'widht' (did you mean 'width'?)");
  EXPECT_EQ(error_of(file_with(value_a), {{"x", true}}), "g.json: /vars: unknown variable 'x'");
}

TEST_F(GraphTest, FindsGraphs) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / "gnomon_graph_test";
  fs::create_directories(folder / "graphs");
  std::ofstream(folder / "graphs" / "my_technique.json") << full_graph;
  setenv("GNOMON_ASSETS", folder.c_str(), 1);
  EXPECT_EQ(find_graph("my_technique"), folder / "graphs" / "my_technique.json");
  EXPECT_EQ(find_graph((folder / "graphs" / "my_technique.json").string()),
            folder / "graphs" / "my_technique.json");
  EXPECT_EQ(load_graph(find_graph("my_technique")).name, "full");
  EXPECT_THROW(find_graph("my_technique.json"), Error);
  try {
    find_graph("my_tecnique");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "unknown graph 'my_tecnique' (did you mean 'my_technique'?)");
  }
  unsetenv("GNOMON_ASSETS");
  fs::remove_all(folder);
}

TEST_F(GraphTest, ResourceRootMustExist) {
  EXPECT_TRUE(std::filesystem::is_directory(resource_root()));
  const char* before = std::getenv("GNOMON_ROOT");
  const std::string kept = before ? before : "";
  setenv("GNOMON_ROOT", "/nonexistent", 1);
  EXPECT_THROW(resource_root(), Error);
  if (before) setenv("GNOMON_ROOT", kept.c_str(), 1);
  if (!before) unsetenv("GNOMON_ROOT");
}

TEST_F(GraphTest, SchemaDescribesEveryPass) {
  const json schema = graph_schema();
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  const json& rules = schema["$defs"]["pass"]["allOf"];
  EXPECT_EQ(rules.size(), PassRegistry::instance().types().size() + 1);
  json found;
  for (const json& rule : rules)
    if (rule["if"]["properties"]["type"]["const"] == "t_filter") found = rule["then"];
  const json& params = found["properties"]["params"]["properties"];
  EXPECT_EQ(params["width"]["anyOf"][0], json::parse(R"({"type": "integer", "minimum": 1, "maximum": 31})"));
  EXPECT_EQ(params["width"]["description"], "side of the kernel; unit: texels");
  EXPECT_EQ(params["width"]["default"], 3);
  EXPECT_EQ(params["mode"]["anyOf"][0]["enum"], json::parse(R"(["box", "tent", "gauss"])"));
  // Inputs are connected one by one, or by naming who gives them.
  EXPECT_EQ(found["anyOf"], json::parse(R"([{"required": ["from"]},
      {"required": ["in"], "properties": {"in": {"required": ["source"]}}}])"));
  EXPECT_EQ(found["properties"]["vars"]["anyOf"][0]["enum"],
            json::parse(R"(["clamp", "mode", "scale", "width"])"));
}

// --- fuzz ---
std::string mutate(std::string text, std::mt19937& random) {
  static const std::vector<std::string> scraps{"{",
                                               "}",
                                               "[",
                                               "]",
                                               ",",
                                               ":",
                                               "\"",
                                               "null",
                                               "-1",
                                               "1e999",
                                               "0",
                                               "99999999999999999999",
                                               "\"$width\"",
                                               "\"a.b\"",
                                               "\"one.result\"",
                                               "\"end.result@previous\"",
                                               "\"loop\"",
                                               "\"t_modify\"",
                                               "\"t_huge\"",
                                               "true",
                                               "//",
                                               "/*",
                                               "\\u0000",
                                               "\xff",
                                               "\"id\": \"draw\",",
                                               "\"in\": {\"source\": \"end.result\"},"};
  const auto pick = [&](size_t n) { return size_t(random() % std::max<size_t>(n, 1)); };
  const int changes = 1 + int(pick(4));
  for (int i = 0; i < changes && !text.empty(); ++i) {
    const size_t at = pick(text.size());
    const size_t length = pick(std::min<size_t>(24, text.size() - at)) + 1;
    switch (pick(6)) {
      case 0:
        text[at] = char(random() % 256);
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, scraps[pick(scraps.size())]);
        break;
      case 3:
        text.insert(at, text.substr(pick(text.size()), length));
        break;
      case 4:
        text.replace(at, length, scraps[pick(scraps.size())]);
        break;
      case 5:
        text.resize(at);
        break;
    }
  }
  return text;
}

// Replaces one string or number by another one of the document: stays JSON, so that the checks behind the
// parser run.
void collect(json& value, std::vector<json*>& leaves) {
  if (!value.is_structured()) leaves.push_back(&value);
  if (value.is_structured())
    for (json& inner : value) collect(inner, leaves);
}

std::string mutate_tree(const json& original, std::mt19937& random) {
  json document = original;
  std::vector<json*> leaves;
  collect(document, leaves);
  const int changes = 1 + int(random() % 3);
  for (int i = 0; i < changes; ++i) {
    const json copy = *leaves[random() % leaves.size()];
    *leaves[random() % leaves.size()] = copy;
  }
  return document.dump();
}

void expect_graph_or_error(const std::string& text, int& good) {
  try {
    const Graph graph = parse_graph(text, "g.json");
    EXPECT_NO_THROW(parse_graph(to_json(graph).dump(), "g.json")) << text;
    ++good;
  } catch (const Error& error) {
    EXPECT_FALSE(error.problems().empty());
  } catch (const std::exception& error) {
    ADD_FAILURE() << error.what() << "\n" << text;
  }
}

TEST_F(GraphTest, FuzzOfTheText) {
  std::mt19937 random(1);
  int good = 0;
  for (int i = 0; i < 6000; ++i) expect_graph_or_error(mutate(full_graph, random), good);
  EXPECT_GT(good, 0);
}

TEST_F(GraphTest, FuzzOfTheTree) {
  std::mt19937 random(2);
  const json document = to_json(parse_graph(full_graph, "g.json"));
  int good = 0;
  for (int i = 0; i < 4000; ++i) expect_graph_or_error(mutate_tree(document, random), good);
  EXPECT_GT(good, 0);
}

}  // namespace
}  // namespace gnomon
