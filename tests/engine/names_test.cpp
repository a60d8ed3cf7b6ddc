// The engine knows no technique by name: no string in engine/ is that of a pass type, graph, port or
// variable.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>

#include "engine/base/input_file.h"
#include "engine/base/resource_root.h"
#include "engine/graph/graph.h"
#include "engine/graph/pass.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

// Words of the engine's own that passes or graphs use, too.
struct Own {
  const char* folder;  // of engine/
  const char* word;
  const char* meaning;
};
constexpr Own own_words[] = {
    {"plan", "visibility", "the graph's output that is measured"},
    {"graph", "pattern", "a keyword of JSON Schema"},
    {"scene", "shape", "a member of a light's extras"},
    {"scene", "radius", "the same"},
    {"scene", "width", "the same"},
    {"scene", "color", "a member of glTF's lights"},
    {"scene", "source", "a member of glTF's textures"},
    {"scene", "weights", "what glTF's animations move"},
    {"scene", "filter", "a member of glTF's compressed buffer views"},
    {"truth", "bias", "a metric"},
    {"truth", "pixels", "a metric's unit"},
    {"truth", "samples", "a member of a reference's file"},
    {"truth", "albedo", "an image in it"},
};

bool is_own(const fs::path& file, const std::string& word) {
  const std::string folder = file.parent_path().filename();
  return std::any_of(std::begin(own_words), std::end(own_words),
                     [&](const Own& own) { return folder == own.folder && word == own.word; });
}

// What each name is one of.
using Names = std::map<std::string, std::string>;

// Which ports there are may depend on flags and choices.
void add_ports(const std::string& type, Names& names) {
  const auto pass = PassRegistry::instance().make(type);
  const auto add = [&](const Values& given) {
    Declaration d({}, given, {});
    pass->declare(d);
    for (const Port& port : d.ports()) names.emplace(port.name, "a port of " + type);
    return d.param_specs();
  };
  for (const ParamSpec& spec : add({})) {
    if (spec.type == ParamType::flag && spec.from.empty())
      add({{spec.name, !std::get<bool>(spec.default_value)}});
    if (spec.from.empty())
      for (const std::string& choice : spec.choices) add({{spec.name, choice}});
  }
}

Names technique_names() {
  Names names;
  for (const std::string& type : PassRegistry::instance().types()) {
    if (type.starts_with("t_")) continue;  // of tests
    names.emplace(type, "a pass type");
    add_ports(type, names);
  }
  for (const fs::path& file : all_graphs()) {
    const Graph graph = load_graph(file);
    names.emplace(graph.name, "a graph");
    for (const auto& [name, value] : graph.vars) names.emplace(name, "a variable of " + graph.name);
  }
  return names;
}

// Contents of the string literals of a C++ file, those of #include left out.
std::vector<std::string> strings_of(const std::string& text) {
  std::vector<std::string> found;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text.compare(i, 2, "//") == 0 || text.compare(i, 8, "#include") == 0) {
      i = std::min(text.find('\n', i), text.size());
    } else if (text.compare(i, 2, "/*") == 0) {
      i = std::min(text.find("*/", i), text.size());
    } else if (text[i] == '\'' && (i == 0 || !std::isalnum(static_cast<unsigned char>(text[i - 1])))) {
      for (++i; i < text.size() && text[i] != '\''; ++i) i += text[i] == '\\';
    } else if (text[i] == '"') {
      std::string literal;
      for (++i; i < text.size() && text[i] != '"'; ++i) {
        if (text[i] == '\\') literal += text[i++];
        literal += text[i];
      }
      found.push_back(std::move(literal));
    }
  }
  return found;
}

TEST(EngineNames, StringsAreFoundAndCommentsAreNot) {
  const std::string text = "#include \"a\"\n// \"b\"\n/* \"c\" */ f('\"', \"d\\\"\", 1'000); g(\"e\");";
  EXPECT_EQ(strings_of(text), (std::vector<std::string>{"d\\\"", "e"}));
}

TEST(EngineNames, NoneIsATechniques) {
  const Names names = technique_names();
  ASSERT_GT(names.size(), 50u);
  size_t strings = 0;
  for (const auto& entry : fs::recursive_directory_iterator(resource_root() / "engine")) {
    const fs::path& file = entry.path();
    if (file.extension() != ".cpp" && file.extension() != ".h") continue;
    for (const std::string& literal : strings_of(read_input_file(file))) {
      ++strings;
      const auto found = names.find(literal);
      if (found != names.end() && !is_own(file, literal))
        ADD_FAILURE() << file << ": \"" << literal << "\" is " << found->second;
    }
  }
  EXPECT_GT(strings, 500u);
}

}  // namespace
}  // namespace gnomon
