// The stability walk: every technique along axes that lead from an ordinary scene to extreme ones.
//
// A case is a set of axis values, "offset=1e6" or "fov=170,scale=1e-3"; the case "base" has none. Each
// technique is judged against its own error at the base case, so that the walk needs to know nothing of it
// but its graph file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/stability/stability_scenes.h"
#include "engine/base/params.h"
#include "engine/graph/graph.h"
#include "engine/graph/pass.h"
#include "engine/truth/reference.h"
#include "engine/vulkan/device_info.h"

namespace gnomon {

struct StabilityAxis {
  std::string name, unit, help;
  std::vector<std::string> values;  // of the whole walk, mildest first
  std::vector<std::string> quick;   // of the quick one
  std::vector<std::string>
      variables;  // of the graph, set to the value; the axis is for graphs that have one of them
  Values with;    // set beside them, where the graph has such variables
  std::function<void(StabilitySetup&, Extent&, const std::string&)>
      apply;              // of the scene or the output; may be empty
  bool map_side = false;  // the variables are those that set the side of the graph's maps, too
};
const std::vector<StabilityAxis>& stability_axes();

// Axis names and values, in the order given; empty: the base case.
using StabilityCase = std::vector<std::pair<std::string, std::string>>;
// Error: not AXIS=VALUE,..., no such axis, an axis twice, a value that is none of the axis'.
StabilityCase parse_stability_case(const std::string& text);
std::string to_string(const StabilityCase& test);

struct StabilityOptions {
  bool quick = false;                                                      // small images and maps
  uint64_t memory = uint64_t{1} << 30;                                     // RenderSettings::memory
  std::vector<StabilityCase> skipped;                                      // left out of the walk
  Extent size() const { return quick ? Extent{48, 36} : Extent{96, 72}; }  // pixels, of the base case
  int64_t shadow_map() const { return quick ? 128 : 256; }                 // texels
  uint32_t samples() const { return quick ? 64 : 256; }                    // of the reference's area light
};

// What one technique did in one case.
struct StabilityMeasurement {
  enum class Ran {
    ran,
    refused,  // with a message: the graph or the scene asks for what cannot be had
    crashed,  // the process died
    timed_out,
    not_applicable  // the graph has none of the axis' variables
  } ran = Ran::ran;
  std::string message;        // why it was refused; the signal
  uint64_t nonfinite = 0;     // values of the visibility and of the shaded image
  uint64_t out_of_range = 0;  // visibility outside [0, 1]
  bool repeats = true;        // two frames have the same bits
  std::vector<std::string> validation, warnings;
  std::string reference;  // "hard", "area" or, when there is none (a large image), empty
  uint64_t pixels = 0;    // counted: the error's domain; 0: there is no error
  double rmse = 0, misclassified = 0;
  std::optional<double> acne, leak;
  double constant_rmse = 0;  // of the best image of one value
};
nlohmann::json to_json(const StabilityMeasurement& m);
StabilityMeasurement measurement_from(const nlohmann::json& json);

// References of the last scene, so that techniques share them.
struct StabilityReferences;
std::shared_ptr<StabilityReferences> make_stability_references();

// `area`: judge against the area light's reference; otherwise against hard shadows. Never throws for what the
// case asks; Error when the device is lost.
StabilityMeasurement measure_stability(const std::shared_ptr<Device>& device,
                                       const std::filesystem::path& graph, const StabilityCase& test,
                                       bool area, const StabilityOptions& options,
                                       StabilityReferences& references);
// Does the technique's image of the base scene depend on the light's size?
bool follows_light_size(const std::shared_ptr<Device>& device, const std::filesystem::path& graph,
                        const StabilityOptions& options);

enum class StabilityVerdict {
  holds,     // error at most 1.1 x that of the base case, plus two pixels
  warned,    // more, and a warning at load said so: outside the technique's domain
  refuses,   // says what cannot be had, before anything is rendered
  degrades,  // more, without a word, but less than that of the best image of one value
  fails
};
std::string to_string(StabilityVerdict verdict);
struct StabilityFinding {
  StabilityCase test;
  StabilityMeasurement measured;
  StabilityVerdict verdict = StabilityVerdict::holds;
  bool broken =
      false;  // crash, time-out, non-finite, out of range, not repeatable, validation: whatever the error
  std::string reason;  // empty when it holds
};
// Of the warnings those count that the base case does not have.
StabilityFinding judge_stability(const StabilityCase& test, const StabilityMeasurement& measured,
                                 const StabilityMeasurement& base);

struct StabilityRow {  // one technique
  std::filesystem::path graph;
  std::string name;
  bool area = false;  // judged against the area light
  StabilityMeasurement base;
  std::vector<StabilityFinding> findings;
};
// Runs one case of one graph: here, or in a process of its own.
using StabilityRunner = std::function<StabilityMeasurement(const std::filesystem::path& graph,
                                                           const StabilityCase& test, bool area)>;
// The graph's base case, then each axis alone (all, or those named), then, unless quick, the worst pairs: of
// the axes where it does worst without failing, each two together.
StabilityRow walk_stability(const std::filesystem::path& graph, bool area, const StabilityOptions& options,
                            const std::vector<std::string>& axes, const StabilityRunner& run,
                            const std::function<void(double, const std::string&)>& progress = {});

// "gnomon stability --graph G --case offset=1e8"
std::string reproduce(const StabilityRow& row, const StabilityCase& test, const StabilityOptions& options);
// The values of each axis on which the technique holds, in words; an axis where it holds throughout is left
// out.
std::map<std::string, std::string> stated_domain(const StabilityRow& row);
nlohmann::json to_json(const std::vector<StabilityRow>& rows, const StabilityOptions& options);
// Markdown: the map of techniques and axes, each technique's domain, the first failing case of each.
std::string stability_report(const std::vector<StabilityRow>& rows, const StabilityOptions& options);

}  // namespace gnomon
