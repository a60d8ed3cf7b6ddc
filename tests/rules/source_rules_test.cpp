// Rules that the source files keep: which folder may include which, how long files and functions are, how
// files begin.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "tests/rules/source_text.h"

namespace gnomon::rules {
namespace {

const std::vector<std::string> kCode{".cpp", ".h"};
const std::vector<std::string> kProgram{"engine", "passes", "bench", "tools"};

// ---------------------------------------------------------------------------------------------- includes

// "engine/base" of a file of the engine, else the first folder.
std::string folder_of(const std::string& file) {
  const size_t first = file.find('/');
  const std::string top = file.substr(0, first);
  return top == "engine" ? file.substr(0, file.find('/', first + 1)) : top;
}

// What the files of a folder may include besides those of their own.
const std::map<std::string, std::set<std::string>>& arrows() {
  static const std::map<std::string, std::set<std::string>> allowed = [] {
    std::map<std::string, std::set<std::string>> a;
    a["engine/base"] = {};
    a["engine/image"] = a["engine/scene"] = a["engine/vulkan"] = {"engine/base"};
    a["engine/scene"].insert("engine/image");
    a["engine/vulkan"].insert("engine/image");
    a["engine/light"] = {"engine/base", "engine/image", "engine/scene"};
    a["engine/graph"] = {"engine/base", "engine/image", "engine/scene", "engine/light"};
    a["engine/plan"] = a["engine/truth"] = a["engine/graph"];
    a["engine/plan"].insert("engine/graph");
    a["engine/truth"].insert("engine/graph");
    a["engine/render"] = a["engine/plan"];
    a["engine/render"].insert({"engine/plan", "engine/vulkan"});
    a["passes"] = a["engine/render"];
    a["passes"].insert("engine/render");
    a["bench"] = a["passes"];
    a["bench"].insert({"engine/truth", "passes"});
    a["tools"] = a["bench"];
    a["tools"].insert("bench");
    a["passes"].erase("engine/plan");
    return a;
  }();
  return allowed;
}

std::vector<std::string> included(const std::string& text) {
  static const std::regex include("(^|\n)[ \t]*#[ \t]*include[ \t]+\"([^\"]+)\"");
  std::vector<std::string> all;
  for (std::sregex_iterator i(text.begin(), text.end(), include), end; i != end; ++i)
    all.push_back((*i)[2].str());
  return all;
}

TEST(SourceRules, IncludesOnlyRunDown) {
  for (const std::string& file : files(kProgram, kCode)) {
    const std::string from = folder_of(file);
    ASSERT_TRUE(arrows().contains(from)) << file << ": the folder has no place in the order";
    for (const std::string& path : included(text_of(file))) {
      const std::string to = folder_of(path);
      EXPECT_TRUE(to == from || arrows().at(from).contains(to)) << file << " includes " << path;
    }
  }
}

void add_included(const std::string& file, std::set<std::string>& all) {
  for (const std::string& path : included(text_of(file)))
    if (all.insert(path).second) add_included(path, all);
}

// A change of the compiler or the renderer must not compile every pass anew.
TEST(SourceRules, PassesSeeNeitherPlanNorRenderer) {
  std::set<std::string> all;
  for (const std::string& file : files({"passes"}, kCode)) add_included(file, all);
  EXPECT_TRUE(all.contains("engine/render/context.h"));
  for (const std::string& path : all) {
    EXPECT_FALSE(path.starts_with("engine/plan/")) << path;
    EXPECT_FALSE(path == "engine/render/renderer.h" || path == "engine/render/device_plan.h") << path;
  }
}

// Pure functions that another engine can take as they are.
TEST(SourceRules, TheShaderLibraryIncludesItselfAlone) {
  for (const std::string& file : files({"shaders/glsl/lib"}, {".glsl"}))
    for (const std::string& path : included(text_of(file)))
      EXPECT_EQ(path.find('/'), std::string::npos) << file << " includes " << path;
}

// ---------------------------------------------------------------------------------------------- lengths

constexpr size_t kMostLines = 400, kMostFunctionLines = 60;

TEST(SourceRules, FilesAreNotLongerThanCanBeOverlooked) {
  for (const std::string& file :
       files({"engine", "passes", "bench", "tools", "shaders"}, {".cpp", ".h", ".glsl"}))
    EXPECT_LE(lines_of(file).size(), kMostLines) << file;
}

TEST(SourceRules, FunctionsAreNotLongerThanCanBeOverlooked) {
  for (const std::string& file : files(kProgram, kCode))
    for (const Function& f : functions(text_of(file)))
      EXPECT_LE(f.lines(), kMostFunctionLines) << file << ":" << f.first << ": " << f.head;
}

TEST(SourceRules, FunctionsAreFound) {
  const std::string text =
      "namespace a {\nstruct S : B {\n  S() : n{1}, m(2) {\n    go();\n  }\n  int n{0};\n};\n"
      "// f() {\nconstexpr int k[] = {1, 2};\nint f(int x) {\n  if (x) { return '{'; }\n  return x;\n}\n"
      "template <typename T>\nT g(T x) {\n  return [&] { return x; }();\n}\n}\n";
  const auto found = functions(text);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].first, 3u);
  EXPECT_EQ(found[0].last, 5u);
  EXPECT_EQ(found[1].first, 10u);
  EXPECT_EQ(found[1].last, 13u);
  EXPECT_EQ(found[2].lines(), 4u);
}

// -------------------------------------------------------------------------------------- software devices

// Devices by name are no reason: what helps a user choose one.
bool is_for_software_devices(const std::string& line) {
  static const std::regex mark("//.*(lavapipe|[Ss]oftware devices?)\\b"), choice("GPU.*lavapipe");
  return std::regex_search(line, mark) && !std::regex_search(line, choice);
}

TEST(SourceRules, WhatSoftwareDevicesNeedIsCollected) {
  const std::string page = text_of("docs/software-devices.md");
  std::set<std::string> marked;
  for (const std::string& file : files({"engine", "passes", "shaders"}, {".cpp", ".h", ".glsl"})) {
    for (const std::string& line : lines_of(file))
      if (is_for_software_devices(line)) marked.insert(file);
    EXPECT_EQ(marked.contains(file), page.find("`" + file + "`") != std::string::npos) << file;
  }
  EXPECT_FALSE(marked.empty());
}

// ------------------------------------------------------------------------------------------- first lines

TEST(SourceRules, FilesBeginWithWhatTheyAreFor) {
  for (const std::string& file : files({"engine", "passes", "bench", "tools", "tests"}, kCode)) {
    const auto lines = lines_of(file);
    ASSERT_FALSE(lines.empty()) << file;
    EXPECT_TRUE(lines[0].starts_with("// ") && lines[0].size() > 10) << file << ": " << lines[0];
  }
}

// ----------------------------------------------------------------------------------------------- constants

TEST(SourceRules, ConstantsOfNamespacesAreNamedAlike) {
  const std::regex constant(
      "(^|\n)(inline |static )*constexpr [^(={;]*\\b([A-Za-z_]\\w*)(\\[[^\\]]*\\])* ?[={]");
  const std::regex name("k[A-Z][A-Za-z0-9]*");
  for (const std::string& file : files(kProgram, kCode)) {
    const std::string text = without_comments_and_strings(text_of(file));
    for (std::sregex_iterator i(text.begin(), text.end(), constant), end; i != end; ++i)
      EXPECT_TRUE(std::regex_match((*i)[3].str(), name)) << file << ": " << (*i)[3];
  }
}

}  // namespace
}  // namespace gnomon::rules
