// One measurement as JSON: a row of results.jsonl, and `gnomon render`'s run.json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/run/rounds.h"
#include "bench/run/sequence.h"
#include "bench/run/statistics.h"
#include "engine/graph/graph.h"
#include "engine/render/renderer.h"

namespace gnomon {

const char* version();  // of the program, "0.1.0"

// Ratio to the baseline, pair by pair over rounds.
struct Ratio {
  std::string baseline;  // graph name and its variables
  Summary value;         // of frame_ms / the baseline's frame_ms
};

struct Row {
  std::string key;  // what was measured, hashed; empty outside a suite
  std::filesystem::path scene;
  std::string graph;
  std::filesystem::path graph_file;
  std::string graph_hash;  // of the graph with its variables resolved
  Values vars, set;        // all of them; those that were set
  Extent size;             // pixels
  uint32_t camera = 0;
  double light_scale = 1;  // as with_light_scale()
  bool reversed_z = true, alias = true, keep_all = false;
  uint32_t reference_samples = 0;  // 0: hard
  DeviceInfo device;
  Samples samples;
  uint64_t memory_limit = uint64_t{1} << 30;  // bytes: RenderSettings::memory
  MemoryUse memory;
  std::vector<LeftOutPass> left_out;
  std::vector<std::string> warnings;
  std::map<std::string, double> facts;
  std::string
      error_json;  // an object (bench/error/measure.h), of a sequence its last frame's; empty: not measured
  std::optional<SequenceResult> sequence;  // frames in order
  uint64_t nonfinite = 0;                  // NaN or Inf values in color and visibility
  std::optional<Ratio> ratio;
  std::map<std::string, double>
      harness_seconds;                        // wall-clock time that `bench` spent: "open", "frames", "error"
  std::map<std::string, std::string> images;  // what is shown -> its file beside results.jsonl
  std::string status = "ok";                  // or "error: ..."
};

// Fills in what a graph says of itself.
void describe_graph(Row& row, const Graph& graph);
// Fills in what a renderer says of itself after its frames.
void describe_renderer(Row& row, const Renderer& renderer);
// Values that are NaN or infinite.
uint64_t count_nonfinite(const Image& image);

nlohmann::json to_json(const Summary& summary);  // {median, mad, ci95: [low, high], n}; null when n = 0
nlohmann::json to_json(const Values& values);
nlohmann::json to_json(const Row& row);

}  // namespace gnomon
