// gnomon check: is a graph, suite or scene file right? All problems at once.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/run/suite.h"
#include "engine/base/config.h"
#include "engine/base/error.h"
#include "engine/base/failure.h"
#include "engine/graph/graph.h"
#include "engine/light/scene_facts.h"
#include "engine/plan/compile.h"
#include "tools/cli.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string count(size_t number, const char* noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

std::string check_scene(const fs::path& file) {
  const Scene scene = load_scene(file);
  for (const std::string& message : scene.warnings.messages) warn(message);
  return fmt::format("scene, {}, {}, {}", count(scene.triangles(), "triangle"),
                     count(scene.lights.size(), "light"), count(scene.warnings.messages.size(), "warning"));
}

std::string check_graph(const fs::path& file) {
  const Graph graph = load_graph(file);
  // A light that shadows something, so that nothing is left out and every pass is checked.
  SceneFacts facts;
  facts.triangles = 1;
  facts.lights = 1;
  facts.has_alpha_mask = facts.has_double_sided = facts.has_open_meshes = true;
  facts.shadowless = {{}};
  facts.light_size = {1};
  const Plan plan = compile(graph, Declaration::Setting{}, facts);
  return fmt::format("graph, {} pass{}", plan.nodes.size(), plan.nodes.size() == 1 ? "" : "es");
}

std::string check_suite(const fs::path& file) {
  const Suite suite = load_suite(file);
  for (const std::string& notice : suite.notices) warn(notice);
  return fmt::format("suite, {}, {}, {}", count(suite.scenes.size(), "scene"),
                     count(all_sizes(suite).size(), "size"), count(suite.configs.size(), "configuration"));
}

// Says what the file is by its content; throws Error with every problem.
std::string check_file(const fs::path& file) {
  if (!fs::exists(file)) fail("no such file", file.string());
  if (fs::is_directory(file)) fail("is a folder", file.string());
  if (file.extension() == ".glb" || file.extension() == ".gltf") return check_scene(file);
  const json content = read_json(file);
  if (content.is_object()) {
    if (content.contains("passes")) return check_graph(file);
    if (content.contains("graphs") || content.contains("scenes")) return check_suite(file);
    if (content.contains("asset")) return check_scene(file);
  }
  fail("neither a graph (\"passes\"), a suite (\"graphs\") nor a scene (glTF)", file.string());
}

int check_command(const std::vector<std::string>& files) {
  int status = exit_done;
  for (const std::string& file : files) {
    try {
      print("{}: ok ({})\n", file, check_file(file));
    } catch (...) {  // the files after it are checked whatever it was
      print_problems(problems_of(std::current_exception(), file));
      status = exit_bad_input;
    }
  }
  return status;
}

}  // namespace

void add_check(CLI::App& app, int& status) {
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("check", "check graph, suite and scene files; needs no device");
  command->add_option("FILE", *files, "what it is, its content says")->required();
  command->footer(
      R"(Prints 'FILE: ok (...)' or every problem with its place, a JSON pointer. Exit status 2 when any file has one.

Examples:
  gnomon check my_technique.json
  gnomon check assets/graphs/*.json bench/suites/*.json scene.glb)");
  command->callback([files, &status] { status = check_command(*files); });
}

}  // namespace gnomon
