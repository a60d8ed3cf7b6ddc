// Reads suites.
#include "bench/run/suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/run/suite_parts.h"
#include "engine/base/config.h"
#include "engine/base/error.h"
#include "engine/base/input_file.h"
#include "engine/base/resource_root.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr long long kMaxSide = 16384;  // pixels; the device's own limit is checked when it is opened
constexpr double kMaxLightScale = 1e6;

bool is_size(const json& value) {
  return value.is_array() && value.size() == 2 && value[0].is_number_integer() &&
         value[1].is_number_integer();
}

void read_size(SuiteReading& reading, const json& value, const std::string& place,
               std::vector<Extent>& sizes) {
  const auto side = [&](size_t i) { return value[i].get<long long>(); };
  if (!is_size(value)) {
    reading.problems.add("a size must be two integers", reading.file, place, "[1280, 720]");
  } else if (side(0) < 1 || side(1) < 1 || side(0) > kMaxSide || side(1) > kMaxSide) {
    reading.problems.add(
        fmt::format("size {}x{}: each side must be in 1..{} pixels", side(0), side(1), kMaxSide),
        reading.file, place);
  } else {
    sizes.push_back({static_cast<uint32_t>(side(0)), static_cast<uint32_t>(side(1))});
  }
}

struct Range {
  long long min, max;
};
void read_count(SuiteReading& reading, ObjectReader& object, const char* key, uint32_t& value,
                const Range& range) {
  const long long given = object.integer(key, value);
  if (given < range.min || given > range.max)
    reading.problems.add(fmt::format("'{}' is {}: must be in {}..{}", key, given, range.min, range.max),
                         reading.file, object.place_of(key));
  else
    value = static_cast<uint32_t>(given);
}

// How often and for how long each technique is measured.
void read_rounds(SuiteReading& reading, ObjectReader& object) {
  Suite& suite = reading.suite;
  read_count(reading, object, "camera", suite.camera, {0, 1000});
  read_count(reading, object, "warmup", suite.warmup, {1, 1000});
  read_count(reading, object, "repeat", suite.repeat, {1, 100000});
  read_count(reading, object, "instrumented", suite.instrumented, {0, 100000});
  suite.seconds = object.number("seconds", suite.seconds);
  read_count(reading, object, "least", suite.least, {1, 100000});
  read_count(reading, object, "frames", suite.frames, {0, 100000});
  suite.fps = object.number("fps", suite.fps);
  if (!(suite.seconds >= 0 && suite.seconds <= 1e6))
    reading.problems.add(fmt::format("'seconds' is {}: must be in 0..1e6", suite.seconds), reading.file,
                         object.place_of("seconds"));
  if (!(suite.fps > 0 && suite.fps <= 1e6))
    reading.problems.add(fmt::format("'fps' is {}: must be above 0 and at most 1e6", suite.fps), reading.file,
                         object.place_of("fps"));
}

// What is compared with, and kept.
void read_outputs(SuiteReading& reading, ObjectReader& object) {
  if (const json* images = object.find("images")) {
    if (images->is_boolean())
      reading.suite.images = images->get<bool>();
    else
      reading.problems.add("'images' must be true or false", reading.file, object.place_of("images"));
  }
  const json* reference = object.find("reference");
  if (reference == nullptr) return;
  if (!reference->is_object()) {
    reading.problems.add("'reference' must be an object", reading.file, object.place_of("reference"),
                         "{\"samples\": 0}");
    return;
  }
  ObjectReader inner(*reference, reading.file, object.place_of("reference"), reading.problems);
  read_count(reading, inner, "samples", reading.suite.samples, {0, 1 << 20});
  inner.finish();
}

template <class T>
void add_missing(std::vector<T>& all, const std::vector<T>& more) {
  for (const T& one : more)
    if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
}

}  // namespace

std::vector<Extent> read_sizes(SuiteReading& reading, const json* size, const std::string& place,
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

std::vector<double> read_light_scales(SuiteReading& reading, const json* scale, const std::string& place,
                                      const std::vector<double>& standard) {
  if (scale == nullptr) return standard;
  std::vector<double> scales;
  for (const json& one : scale->is_array() ? *scale : json::array({*scale})) {
    if (!one.is_number() || !(one.get<double>() >= 0 && one.get<double>() <= kMaxLightScale))
      reading.problems.add(
          fmt::format("light scale {}: must be a number in 0..{:g}", one.dump(), kMaxLightScale),
          reading.file, place, "\"light_scale\": [0, 0.5, 1, 2]");
    else if (std::find(scales.begin(), scales.end(), one.get<double>()) == scales.end())
      scales.push_back(one.get<double>());
  }
  if (scale->is_array() && scale->empty())
    reading.problems.add("'light_scale' is an empty list", reading.file, place);
  return scales;
}

Suite parse_suite(const std::string& text, const fs::path& file) {
  Suite suite;
  suite.file = file;
  suite.name = file.stem().string();
  const json root = parse_json(text, file.string());
  if (!root.is_object()) fail("a suite must be a JSON object", file.string());
  Problems problems;
  SuiteReading reading{suite, problems, file.string()};
  ObjectReader object(root, file.string(), "", problems);
  if (const long long schema = object.integer("schema", 1); schema != 1)
    problems.add(fmt::format("schema {} is not known", schema), file.string(), object.place_of("schema"),
                 "1");
  object.find("comment");
  read_scenes(reading, object.find("scenes"), object.place_of("scenes"));
  suite.sizes = read_sizes(reading, object.find("size"), object.place_of("size"), {{1280, 720}});
  suite.light_scales = read_light_scales(reading, object.find("light_scale"), object.place_of("light_scale"),
                                         suite.light_scales);
  read_rounds(reading, object);
  read_outputs(reading, object);
  const json* graphs = object.find("graphs");
  read_graphs(reading, graphs, object.place_of("graphs"));
  if (graphs != nullptr) suite.graphs = std::make_shared<const json>(*graphs);
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

Suite load_suite(const fs::path& file) {
  if (std::error_code ignored; !fs::exists(file, ignored))
    fail("cannot open the suite", file.string(), {}, "bench/suites holds some: gnomon bench hard");
  return parse_suite(read_input_file(file), file);
}

fs::path find_suite(const std::string& name_or_file) {
  fs::path given(name_or_file);
  if (fs::is_regular_file(given) || given.has_parent_path() || given.has_extension()) return given;
  fs::path named = resource_root() / "bench" / "suites" / (name_or_file + ".json");
  return fs::exists(named) ? named : given;
}

}  // namespace gnomon
