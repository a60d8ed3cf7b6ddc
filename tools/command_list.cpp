// gnomon list: what there is.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/config.h"
#include "engine/base/error.h"
#include "engine/base/resource_root.h"
#include "engine/graph/graph.h"
#include "engine/graph/pass.h"
#include "engine/truth/metrics.h"
#include "tools/cli.h"
#include "tools/terminal.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

const char* direction_name(Direction direction) {
  switch (direction) {
    case Direction::in:
      return "in";
    case Direction::out:
      return "out";
    case Direction::inout:
      return "inout";
    case Direction::transient:
      return "own";
  }
  return "?";
}

std::string range_of(const ParamSpec& spec) {
  switch (spec.type) {
    case ParamType::flag:
      return "true or false";
    case ParamType::choice:
      return fmt::format("one of {}", fmt::join(spec.choices, ", "));
    case ParamType::integer:
      return fmt::format("{:.0f}..{:.0f} {}", spec.min, spec.max, spec.unit);
    case ParamType::number:
      return fmt::format("{:g}..{:g} {}", spec.min, spec.max, spec.unit);
  }
  return "?";
}

std::string joined(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

// What outputs say of themselves, and what is taken from inputs' sources.
void list_traits(const Declaration& declaration) {
  for (const Port& port : declaration.ports()) {
    std::vector<std::string> said, taken;
    if (port.direction != Direction::in)
      for (const auto& [key, value] : port.traits) said.push_back(key);
    for (const ParamSpec& spec : declaration.param_specs())
      if (spec.from == port.name) taken.push_back(spec.name);
    if (!said.empty()) print("  trait {:<18}says {}\n", port.name, joined(said));
    if (!taken.empty()) print("  trait {:<18}is asked for {}\n", port.name, joined(taken));
  }
}

void list_passes() {
  for (const std::string& type : PassRegistry::instance().types()) {
    Declaration declaration;
    PassRegistry::instance().make(type)->declare(declaration);
    print("{}  {}\n", type, declaration.summary());
    if (!declaration.cite().empty()) print("  source: {}\n", declaration.cite());
    for (const Port& port : declaration.ports()) {
      if (port.direction == Direction::transient) continue;
      print("  {:<6}{:<18}{}{}\n", direction_name(port.direction), port.name,
            port.optional ? "(optional) " : "", port.help);
    }
    for (const ParamSpec& spec : declaration.param_specs())
      if (spec.from.empty())
        print("  param {:<18}{} [default {}; {}]\n", spec.name, spec.help, to_string(spec.default_value),
              range_of(spec));
    list_traits(declaration);
    print("\n");
  }
}

void list_graphs() {
  for (const fs::path& file : all_graphs()) {
    const Graph graph = load_graph(file);
    print("{:<24}{}\n", graph.name, graph.cite);
    for (const auto& [name, value] : graph.vars) print("  --set {}={}\n", name, to_string(value));
  }
}

void list_scenes_in(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf")
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files)
    print("{:<24}{:>8} kB  {}\n", file.stem().string(), fs::file_size(file) / 1000,
          file.lexically_normal().string());
}

void list_scenes() {
  list_scenes_in(resource_root() / "assets" / "scenes");
  if (const char* folder = std::getenv("GNOMON_SCENES")) list_scenes_in(folder);
}

void list_metrics() {
  for (const MetricInfo& info : metric_infos()) {
    print("{:<20}[{}] {}\n", info.name, info.unit, info.definition);
    if (!info.source.empty()) print("{:<20}source: {}\n", "", info.source);
  }
}

void list_devices_found() {
  const std::vector<DeviceInfo> devices = list_devices();
  if (devices.empty())
    fail("no Vulkan device", {}, {},
         "install a Vulkan driver; mesa-vulkan-drivers holds lavapipe, which needs no GPU");
  for (const DeviceInfo& device : devices)
    print("{}  ({}{})\n", device.name, device.driver, device.is_cpu ? ", software" : "");
}

struct Topic {
  const char* name;
  const char* help;
  void (*list)();
};
constexpr Topic kTopics[] = {
    {"passes", "pass types with their ports and parameters", list_passes},
    {"graphs", "techniques in assets/graphs with their variables and defaults", list_graphs},
    {"scenes", "scenes in assets/scenes and $GNOMON_SCENES", list_scenes},
    {"metrics", "error metrics: definition, unit, source", list_metrics},
    {"devices", "Vulkan devices, for --device", list_devices_found},
    {"schema", "the JSON Schema of graph files", [] { print_lines(stdout, graph_schema().dump(2) + "\n"); }},
};

}  // namespace

void add_list(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("list", "list passes, graphs, scenes, metrics or devices");
  command->require_subcommand(1);
  for (const Topic& topic : kTopics) {
    command->add_subcommand(topic.name, topic.help)->callback([&topic, &status] {
      topic.list();
      status = exit_done;
    });
  }
  command->footer("Example:\n  gnomon list passes");
}

}  // namespace gnomon
