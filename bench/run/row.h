// One measurement: a row of results.jsonl, and `gnomon render`'s run.json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/error/measure.h"
#include "bench/run/rounds.h"
#include "bench/run/sequence.h"
#include "bench/run/statistics.h"
#include "engine/graph/graph.h"
#include "engine/render/renderer.h"

namespace gnomon {

const char* version();  // of the program, "0.1.0"

// Ratio to the baseline, pair by pair over rounds.
struct Ratio {
  std::string baseline;  // the label of its row
  Summary value;         // of frame_ms / the baseline's frame_ms
};

// Milliseconds of the two ways to take time stamps.
struct GpuTimes {
  std::optional<Summary> overlapped, isolated;
};
struct PassFigures {
  std::string id, type;
  uint32_t iteration = 0;  // of its loop
  GpuTimes gpu_ms;
  double cpu_ms = 0, host_wait_ms = 0;  // medians
};

struct RowReference {
  uint32_t samples = 0;  // on each area light; 0: hard
};
struct RowMemory {
  uint64_t limit_bytes = uint64_t{1} << 30;  // RenderSettings::memory
  MemoryUse use;
};

// Of a sequence, over its frames.
struct SequenceFigures {
  uint64_t frames = 0;
  std::optional<Spread> rmse, flicker;
};

// What is absent was not measured. Names and order of the members of the JSON: row_json.cpp.
struct Row {
  std::string program = version();
  std::string key;                   // what was measured, hashed; empty outside a suite
  std::string scene;                 // the file's name without its extension
  std::filesystem::path scene_file;  // both: set_scene()
  std::string graph;
  std::filesystem::path graph_file;
  std::string graph_hash;  // of the graph with its variables resolved
  Values vars, set;        // all of them; those that were set
  Extent size;             // pixels
  uint32_t camera = 0;
  double light_scale = 1;  // as with_light_scale()
  bool reversed_z = true, alias = true, keep_all = false;
  DeviceInfo device;
  std::optional<Summary> frame_ms, record_ms;
  GpuTimes gpu_ms;
  std::vector<PassFigures> passes;
  std::optional<MeasuredError> error;  // of a sequence its last frame's
  std::optional<RowReference> reference;
  double light_samples = 1;  // that the technique itself took
  RowMemory memory;
  std::vector<LeftOutPass> left_out;
  uint64_t nonfinite = 0;  // NaN or Inf values in color and visibility
  std::optional<Ratio> ratio;
  bool is_baseline = false;  // of its suite: others' ratios are to it
  std::vector<std::string> warnings;
  std::map<std::string, double> facts;
  std::vector<FrameResult> frames;  // of a sequence, in order
  std::optional<SequenceFigures> sequence;
  std::optional<double> flicker;  // of a sequence: the mean
  std::map<std::string, double>
      harness_seconds;                        // wall-clock time that `bench` spent: "open", "frames", "error"
  std::map<std::string, std::string> images;  // what is shown -> its file beside results.jsonl
  std::string status = "ok";                  // or "error: ..."

  bool ok() const { return status == "ok"; }
};

void set_scene(Row& row, const std::filesystem::path& file);
// Fills in what a graph says of itself.
void describe_graph(Row& row, const Graph& graph);
// Fills in what a renderer says of itself after its frames.
void describe_renderer(Row& row, const Renderer& renderer);
// Fills in the times that rounds gave.
void describe_samples(Row& row, const Samples& samples);
// Fills in the frames of a sequence and what is reported over all of them.
void describe_sequence(Row& row, const SequenceResult& result);
// Values that are NaN or infinite.
uint64_t count_nonfinite(const Image& image);

// "pcf kernel=15 shadow_map=512": a graph and what was set.
std::string label_of(const std::string& graph, const Values& set);
std::string label_of(const Row& row);

// Names of the metrics in which less is better, in the order of choice: rmse, mae, misclassified, ...
const std::vector<std::string>& error_metrics();
// The figure of that name, when it is there and finite.
std::optional<double> figure_of(const MeasuredError& error, const std::string& metric);
std::optional<double> figure_of(const std::optional<MeasuredError>& error, const std::string& metric);

nlohmann::json to_json(const Summary& summary);  // {median, mad, ci95: [low, high], n}; null when n = 0
nlohmann::json to_json(const Values& values);
nlohmann::json to_json(const Row& row);
// Members that are not there have their defaults; `line`: of `file`, for errors. Error: a member of another
// kind than rows have.
Row row_from(const nlohmann::json& object, const std::string& file = {}, const std::string& line = {});

}  // namespace gnomon
