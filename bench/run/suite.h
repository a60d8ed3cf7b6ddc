// A suite file: which techniques are compared on which scenes, at which sizes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/graph/graph.h"

namespace gnomon {

// One technique with one combination of swept variables.
struct SuiteConfig {
  Graph graph;                               // variables resolved
  Values set;                                // what the suite sets, this combination
  size_t entry = 0;                          // index into "graphs"
  std::vector<Extent> sizes;                 // pixels: its own, or the suite's
  std::vector<double> light_scales = {1.0};  // as with_light_scale(): its own, or the suite's
  size_t baseline = 0;                       // index of the configuration that this one is compared with
};

struct Suite {
  std::filesystem::path file;
  std::string name;                           // file name without folder and extension
  std::vector<std::filesystem::path> scenes;  // existing files, in the suite's order, each once
  std::vector<Extent> sizes;                  // pixels: of the graphs without sizes of their own
  std::vector<double> light_scales = {1.0};   // of the graphs without any of their own
  std::string baseline;                       // name of a graph of the suite
  std::vector<SuiteConfig> configs;           // sweeps expanded
  uint32_t camera = 0;
  uint32_t warmup = 2;                  // frames
  uint32_t repeat = 11;                 // rounds that are timed without stamps
  uint32_t frames = 0;                  // of a sequence from the scene's time 0, instead of `repeat`; 0: none
  double fps = 30;                      // frames a second of the scene's time
  uint32_t instrumented = 5;            // rounds with stamps, of each mode
  double seconds = 0;                   // of a row's rounds, as RoundSettings::seconds; 0: no limit
  uint32_t least = 5;                   // rounds whatever they take, with `seconds`
  uint32_t samples = 0;                 // of the reference; 0: hard shadows of the lights' centres
  uint64_t memory = uint64_t{1} << 30;  // bytes: RenderSettings::memory; not in the file
  bool images = false;                  // write PNGs of every row beside the results
  std::shared_ptr<const nlohmann::json> graphs;  // "graphs" as written; null: made otherwise
  std::vector<std::string> notices;              // scenes that are not there, one sentence each
};

// Every size at which some graph is measured, each once: the suite's first.
std::vector<Extent> all_sizes(const Suite& suite);
std::vector<double> all_light_scales(const Suite& suite);

// Reads and checks a suite and the graphs it names; all problems at once (Error). Scenes are paths relative
// to the suite file, absolute ones, patterns (dragon*.glb), folders (every .glb and .gltf in them), or begin
// with $GNOMON_SCENES: the environment variable of that name, else shared/scenes beside the source tree. A
// missing $GNOMON_SCENES or an empty pattern is a notice, a missing plain file a problem; no scene at all is
// a problem too.
Suite load_suite(const std::filesystem::path& file);
// `file` names the suite in errors and is what scenes are relative to.
Suite parse_suite(const std::string& text, const std::filesystem::path& file);

// NAME -> bench/suites/NAME.json under resource_root(), FILE as it is.
std::filesystem::path find_suite(const std::string& name_or_file);

}  // namespace gnomon
