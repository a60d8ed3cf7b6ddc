// Reads the techniques of a suite, expands their sweeps, and finds each one's baseline.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/run/suite_parts.h"
#include "engine/base/config.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Where configurations are measured.
struct Measured {
  std::vector<Extent> sizes;
  std::vector<double> light_scales;
};

void add_configs(SuiteReading& reading, const std::string& name, const json* set, const Measured& at,
                 size_t entry, const std::string& place) {
  fs::path file;
  std::vector<Values> combinations{{}};
  Problems found;
  if (set != nullptr) combinations = expand_sweep(*set, reading.file, place + "/set", found);
  for (const Problem& problem : found.all())
    reading.problems.add(problem.what, problem.file, problem.place, problem.hint);
  if (!found.empty()) return;
  std::set<std::string> reported;  // the combinations of one sweep share most of their mistakes
  for (const Values& values : combinations) {
    try {
      reading.suite.configs.push_back(
          {load_graph(find_graph(name), values), values, entry, at.sizes, at.light_scales, 0});
    } catch (const Error& error) {
      for (const Problem& problem : error.problems()) {
        if (!reported.insert(to_string(problem)).second) continue;
        const bool own_place = problem.file.empty();
        reading.problems.add(problem.what, own_place ? reading.file : problem.file,
                             own_place ? place : problem.place, problem.hint);
      }
    }
  }
}

// How well `candidate` stands for `config`: first by equal variables that the suite sets on either side, then
// by variables at their defaults (`standard`).
std::pair<size_t, size_t> likeness(const SuiteConfig& candidate, const SuiteConfig& config,
                                   const Values& standard) {
  std::pair<size_t, size_t> score{0, 0};
  for (const auto& [name, value] : candidate.set) {
    const auto other = config.graph.vars.find(name);
    if (other != config.graph.vars.end() && other->second == value) ++score.first;
    const auto usual = standard.find(name);
    if (usual != standard.end() && usual->second == value) ++score.second;
  }
  return score;
}

}  // namespace

void read_graphs(SuiteReading& reading, const json* graphs, const std::string& place) {
  if (graphs == nullptr || !graphs->is_array() || graphs->empty()) {
    reading.problems.add("'graphs' must be a list of graph names", reading.file, place,
                         "[\"shadow_mapping\"]");
    return;
  }
  const Measured standard{reading.suite.sizes, reading.suite.light_scales};
  for (size_t i = 0; i < graphs->size(); ++i) {
    const json& entry = (*graphs)[i];
    const std::string here = fmt::format("{}/{}", place, i);
    if (entry.is_string()) {
      add_configs(reading, entry.get<std::string>(), nullptr, standard, i, here);
    } else if (entry.is_object()) {
      ObjectReader object(entry, reading.file, here, reading.problems);
      const std::string name = object.required_text("name");
      const json* set = object.find("set");
      const Measured at{read_sizes(reading, object.find("size"), object.place_of("size"), standard.sizes),
                        read_light_scales(reading, object.find("light_scale"), object.place_of("light_scale"),
                                          standard.light_scales)};
      object.finish();
      if (!name.empty()) add_configs(reading, name, set, at, i, here);
    } else {
      reading.problems.add("a graph must be a name or {\"name\": ..., \"set\": {...}}", reading.file, here);
    }
  }
}

void match_baselines(SuiteReading& reading, const std::string& place) {
  Suite& suite = reading.suite;
  const auto first = std::find_if(suite.configs.begin(), suite.configs.end(),
                                  [&](const SuiteConfig& c) { return c.graph.name == suite.baseline; });
  if (first == suite.configs.end()) {
    std::vector<std::string> names;
    for (const SuiteConfig& config : suite.configs) names.push_back(config.graph.name);
    reading.problems.add(fmt::format("baseline '{}' is not one of the suite's graphs", suite.baseline),
                         reading.file, place, did_you_mean(suite.baseline, names));
    return;
  }
  const Values standard = load_graph(first->graph.file).vars;
  for (SuiteConfig& config : suite.configs) {
    auto best = static_cast<size_t>(first - suite.configs.begin());
    for (size_t i = best; i < suite.configs.size(); ++i) {
      if (suite.configs[i].entry != first->entry) break;
      if (likeness(suite.configs[i], config, standard) > likeness(suite.configs[best], config, standard))
        best = i;
    }
    config.baseline = best;
  }
}

}  // namespace gnomon
