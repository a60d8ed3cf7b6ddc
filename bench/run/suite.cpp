// Reads a suite file and expands its swept variables.
#include "bench/run/suite.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "engine/base/config.h"
#include "engine/base/error.h"
#include "engine/base/resource_root.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr long long max_side = 16384;  // pixels; the device's own limit is checked when it is opened
constexpr double max_light_scale = 1e6;
constexpr std::string_view scenes_variable = "$GNOMON_SCENES";

struct Reading {
  Suite& suite;
  Problems& problems;
  std::string file;
};

bool is_scene(const fs::path& path) { return path.extension() == ".glb" || path.extension() == ".gltf"; }

std::vector<fs::path> scenes_in(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_scene(entry.path())) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<fs::path> matches(const fs::path& pattern) {
  glob_t found{};
  std::vector<fs::path> paths;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
    for (size_t i = 0; i < found.gl_pathc; ++i) paths.emplace_back(found.gl_pathv[i]);
  globfree(&found);
  return paths;
}

fs::path real_scenes_folder() {
  const char* given = std::getenv("GNOMON_SCENES");
  return given != nullptr && *given != '\0' ? fs::path(given) : resource_root() / ".." / "shared" / "scenes";
}

void add_scene(Suite& suite, const fs::path& path) {
  const fs::path clean = fs::weakly_canonical(path);
  if (std::find(suite.scenes.begin(), suite.scenes.end(), clean) == suite.scenes.end())
    suite.scenes.push_back(clean);
}

void read_scene(Reading& reading, const std::string& text, const std::string& place) {
  fs::path path;
  const bool real = text.starts_with(scenes_variable);
  if (real) {
    const fs::path folder = real_scenes_folder();
    if (!fs::is_directory(folder)) {
      reading.suite.notices.push_back(
          fmt::format("no folder {}: '{}' is left out (set GNOMON_SCENES to the folder of scenes)",
                      folder.lexically_normal().string(), text));
      return;
    }
    path = folder / fs::path(text.substr(scenes_variable.size())).relative_path();
  } else {
    path = fs::path(reading.file).parent_path() / text;
  }
  if (fs::is_directory(path)) {
    for (const fs::path& scene : scenes_in(path)) add_scene(reading.suite, scene);
  } else if (text.find_first_of("*?[") != std::string::npos) {
    const auto found = matches(path);
    if (found.empty())
      reading.suite.notices.push_back(fmt::format("no scene matches '{}'", path.lexically_normal().string()));
    for (const fs::path& scene : found) add_scene(reading.suite, scene);
  } else if (fs::is_regular_file(path)) {
    add_scene(reading.suite, path);
  } else if (real) {
    reading.suite.notices.push_back(fmt::format("no scene {}", path.lexically_normal().string()));
  } else {
    reading.problems.add(fmt::format("no such scene '{}'", path.lexically_normal().string()), reading.file,
                         place, "scenes are relative to the suite file");
  }
}

void read_scenes(Reading& reading, const json* scenes, const std::string& place) {
  if (scenes == nullptr || !scenes->is_array() || scenes->empty()) {
    reading.problems.add("'scenes' must be a list of files", reading.file, place,
                         "[\"../../assets/scenes/fence.glb\"]");
    return;
  }
  for (size_t i = 0; i < scenes->size(); ++i) {
    const std::string here = fmt::format("{}/{}", place, i);
    if ((*scenes)[i].is_string())
      read_scene(reading, (*scenes)[i].get<std::string>(), here);
    else
      reading.problems.add("a scene must be a string", reading.file, here);
  }
  if (reading.suite.scenes.empty() && reading.problems.empty())
    reading.problems.add("none of the scenes exists", reading.file, place);
}

bool is_size(const json& value) {
  return value.is_array() && value.size() == 2 && value[0].is_number_integer() &&
         value[1].is_number_integer();
}

void read_size(Reading& reading, const json& value, const std::string& place, std::vector<Extent>& sizes) {
  const auto side = [&](size_t i) { return value[i].get<long long>(); };
  if (!is_size(value)) {
    reading.problems.add("a size must be two integers", reading.file, place, "[1280, 720]");
  } else if (side(0) < 1 || side(1) < 1 || side(0) > max_side || side(1) > max_side) {
    reading.problems.add(
        fmt::format("size {}x{}: each side must be in 1..{} pixels", side(0), side(1), max_side),
        reading.file, place);
  } else {
    sizes.push_back({static_cast<uint32_t>(side(0)), static_cast<uint32_t>(side(1))});
  }
}

// `standard`: where there are none.
std::vector<Extent> read_sizes(Reading& reading, const json* size, const std::string& place,
                               const std::vector<Extent>& standard) {
  if (size == nullptr) return standard;
  std::vector<Extent> sizes;
  if (size->is_array() && !size->empty() && (*size)[0].is_array()) {
    for (size_t i = 0; i < size->size(); ++i)
      read_size(reading, (*size)[i], fmt::format("{}/{}", place, i), sizes);
  } else {
    read_size(reading, *size, place, sizes);
  }
  return sizes;
}

std::vector<double> read_light_scales(Reading& reading, const json* scale, const std::string& place,
                                      const std::vector<double>& standard) {
  if (scale == nullptr) return standard;
  std::vector<double> scales;
  for (const json& one : scale->is_array() ? *scale : json::array({*scale})) {
    if (!one.is_number() || !(one.get<double>() >= 0 && one.get<double>() <= max_light_scale))
      reading.problems.add(
          fmt::format("light scale {}: must be a number in 0..{:g}", one.dump(), max_light_scale),
          reading.file, place, "\"light_scale\": [0, 0.5, 1, 2]");
    else if (std::find(scales.begin(), scales.end(), one.get<double>()) == scales.end())
      scales.push_back(one.get<double>());
  }
  if (scale->is_array() && scale->empty())
    reading.problems.add("'light_scale' is an empty list", reading.file, place);
  return scales;
}

// Where configurations are measured.
struct Measured {
  std::vector<Extent> sizes;
  std::vector<double> light_scales;
};

void add_configs(Reading& reading, const std::string& name, const json* set, const Measured& at, size_t entry,
                 const std::string& place) {
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

void read_graphs(Reading& reading, const json* graphs, const std::string& place) {
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

// The first entry that names the baseline holds the candidates, so that a later entry may sweep the same
// graph.
void match_baselines(Reading& reading, const std::string& place) {
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

uint32_t read_count(ObjectReader& object, Problems& problems, const std::string& file, const char* key,
                    uint32_t standard, long long min, long long max) {
  const long long value = object.integer(key, standard);
  if (value < min || value > max) {
    problems.add(fmt::format("'{}' is {}: must be in {}..{}", key, value, min, max), file,
                 object.place_of(key));
    return standard;
  }
  return static_cast<uint32_t>(value);
}

template <class T>
void add_missing(std::vector<T>& all, const std::vector<T>& more) {
  for (const T& one : more)
    if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
}

std::string read_whole(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) fail("is a folder, not a suite file", file.string());
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail("cannot open the suite", file.string(), {}, "bench/suites holds some: gnomon bench hard");
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

Suite parse_suite(const std::string& text, const fs::path& file) {
  Suite suite;
  suite.file = file;
  suite.name = file.stem().string();
  const json root = parse_json(text, file.string());
  if (!root.is_object()) fail("a suite must be a JSON object", file.string());
  Problems problems;
  Reading reading{suite, problems, file.string()};
  ObjectReader object(root, file.string(), "", problems);
  if (const long long schema = object.integer("schema", 1); schema != 1)
    problems.add(fmt::format("schema {} is not known", schema), file.string(), object.place_of("schema"),
                 "1");
  object.find("comment");
  read_scenes(reading, object.find("scenes"), object.place_of("scenes"));
  suite.sizes = read_sizes(reading, object.find("size"), object.place_of("size"), {{1280, 720}});
  suite.light_scales = read_light_scales(reading, object.find("light_scale"), object.place_of("light_scale"),
                                         suite.light_scales);
  suite.camera = read_count(object, problems, file.string(), "camera", 0, 0, 1000);
  suite.warmup = read_count(object, problems, file.string(), "warmup", suite.warmup, 1, 1000);
  suite.repeat = read_count(object, problems, file.string(), "repeat", suite.repeat, 1, 100000);
  suite.instrumented =
      read_count(object, problems, file.string(), "instrumented", suite.instrumented, 0, 100000);
  suite.seconds = object.number("seconds", suite.seconds);
  suite.least = read_count(object, problems, file.string(), "least", suite.least, 1, 100000);
  suite.frames = read_count(object, problems, file.string(), "frames", suite.frames, 0, 100000);
  suite.fps = object.number("fps", suite.fps);
  if (const json* images = object.find("images")) {
    if (images->is_boolean())
      suite.images = images->get<bool>();
    else
      problems.add("'images' must be true or false", file.string(), object.place_of("images"));
  }
  if (!(suite.seconds >= 0 && suite.seconds <= 1e6))
    problems.add(fmt::format("'seconds' is {}: must be in 0..1e6", suite.seconds), file.string(),
                 object.place_of("seconds"));
  if (!(suite.fps > 0 && suite.fps <= 1e6))
    problems.add(fmt::format("'fps' is {}: must be above 0 and at most 1e6", suite.fps), file.string(),
                 object.place_of("fps"));
  if (const json* reference = object.find("reference")) {
    if (reference->is_object()) {
      ObjectReader inner(*reference, file.string(), object.place_of("reference"), problems);
      suite.samples = read_count(inner, problems, file.string(), "samples", 0, 0, 1 << 20);
      inner.finish();
    } else {
      problems.add("'reference' must be an object", file.string(), object.place_of("reference"),
                   "{\"samples\": 0}");
    }
  }
  const json* graphs = object.find("graphs");
  read_graphs(reading, graphs, object.place_of("graphs"));
  if (graphs != nullptr) suite.graphs_json = graphs->dump();
  suite.baseline = object.text("baseline", suite.configs.empty() ? "" : suite.configs.front().graph.name);
  const std::string baseline_place = object.place_of("baseline");
  object.finish();
  if (problems.empty()) match_baselines(reading, baseline_place);
  problems.raise();
  return suite;
}

std::vector<Extent> all_sizes(const Suite& suite) {
  std::vector<Extent> all = suite.sizes;
  for (const SuiteConfig& config : suite.configs) add_missing(all, config.sizes);
  return all;
}

std::vector<double> all_light_scales(const Suite& suite) {
  std::vector<double> all = suite.light_scales;
  for (const SuiteConfig& config : suite.configs) add_missing(all, config.light_scales);
  return all;
}

Suite load_suite(const fs::path& file) { return parse_suite(read_whole(file), file); }

fs::path find_suite(const std::string& name_or_file) {
  fs::path given(name_or_file);
  if (fs::is_regular_file(given) || given.has_parent_path() || given.has_extension()) return given;
  fs::path named = resource_root() / "bench" / "suites" / (name_or_file + ".json");
  return fs::exists(named) ? named : given;
}

}  // namespace gnomon
