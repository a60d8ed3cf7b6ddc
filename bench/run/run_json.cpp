// Writes one measurement as JSON: a row of results.jsonl, or run.json.
#include "bench/run/run_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/base/config.h"

namespace gnomon {
namespace {

using nlohmann::json;
using PassKey = std::pair<std::string, uint32_t>;  // id, iteration

struct PassSamples {
  std::string type;
  std::vector<double> gpu_overlapped, gpu_isolated, cpu, wait;
};

// Passes in the order of their first appearance; a pass that never ran has no entry.
class PassTable {
 public:
  PassSamples& at(const PassTiming& timing) {
    const PassKey key{timing.id, timing.iteration};
    const auto found = index_.find(key);
    if (found != index_.end()) return entries_[found->second].second;
    index_[key] = entries_.size();
    entries_.push_back({key, {timing.type, {}, {}, {}, {}}});
    return entries_.back().second;
  }
  const std::vector<std::pair<PassKey, PassSamples>>& entries() const { return entries_; }

 private:
  std::map<PassKey, size_t> index_;
  std::vector<std::pair<PassKey, PassSamples>> entries_;
};

json passes_of(const Samples& samples) {
  PassTable table;
  for (const FrameTiming& frame : samples.overlapped) {
    for (const PassTiming& timing : frame.passes) {
      PassSamples& pass = table.at(timing);
      pass.gpu_overlapped.push_back(timing.gpu_ms);
      pass.cpu.push_back(timing.cpu_ms);
      pass.wait.push_back(timing.host_wait_ms);
    }
  }
  for (const FrameTiming& frame : samples.isolated)
    for (const PassTiming& timing : frame.passes) table.at(timing).gpu_isolated.push_back(timing.gpu_ms);
  json rows = json::array();
  for (const auto& [key, pass] : table.entries()) {
    rows.push_back({{"id", key.first},
                    {"type", pass.type},
                    {"iteration", key.second},
                    {"gpu_ms",
                     {{"overlapped", to_json(summarise(pass.gpu_overlapped))},
                      {"isolated", to_json(summarise(pass.gpu_isolated))}}},
                    {"cpu_ms", median(pass.cpu)},
                    {"host_wait_ms", median(pass.wait)}});
  }
  return rows;
}

json gpu_of(const std::vector<FrameTiming>& frames) {
  std::vector<double> values;
  values.reserve(frames.size());
  for (const FrameTiming& frame : frames) values.push_back(frame.gpu_ms);
  return to_json(summarise(values));
}

json left_out_of(const std::vector<LeftOutPass>& passes) {
  json rows = json::array();
  for (const LeftOutPass& pass : passes)
    rows.push_back({{"pass", pass.pass}, {"part", pass.part}, {"reason", pass.reason}});
  return rows;
}

// Techniques that sample an area light say with how many samples; every other one uses the light's centre.
double light_samples_of(const std::map<std::string, double>& facts) {
  for (const auto& [name, value] : facts)
    if (name == "light_samples" || name.ends_with(".light_samples")) return value;
  return 1;
}

json ratio_of(const std::optional<Ratio>& ratio) {
  if (!ratio || ratio->value.n == 0) return nullptr;
  json object = to_json(ratio->value);
  object["baseline"] = ratio->baseline;
  return object;
}

}  // namespace

const char* version() { return GNOMON_VERSION; }

void describe_graph(Row& row, const Graph& graph) {
  row.graph = graph.name;
  row.graph_file = graph.file;
  row.graph_hash = canonical_hash(to_json(graph));
  row.vars = graph.vars;
}

void describe_renderer(Row& row, const Renderer& renderer) {
  row.memory = renderer.memory();
  row.left_out = renderer.left_out();
  row.warnings = renderer.warnings();
  row.facts = renderer.facts();
}

uint64_t count_nonfinite(const Image& image) {
  return static_cast<uint64_t>(
      std::count_if(image.data.begin(), image.data.end(), [](float x) { return !std::isfinite(x); }));
}

json to_json(const Summary& summary) {
  if (summary.n == 0) return nullptr;
  return {{"median", summary.median},
          {"mad", summary.mad},
          {"ci95", json::array({summary.low, summary.high})},
          {"n", summary.n}};
}

json to_json(const Values& values) {
  json object = json::object();
  for (const auto& [name, value] : values)
    std::visit([&, &key = name](const auto& v) { object[key] = v; }, value);
  return object;
}

json to_json(const Row& row) {
  json object = {
      {"gnomon", version()},
      {"scene", row.scene.stem().string()},
      {"scene_file", row.scene.string()},
      {"graph", row.graph},
      {"graph_file", row.graph_file.string()},
      {"graph_hash", row.graph_hash},
      {"vars", to_json(row.vars)},
      {"set", to_json(row.set)},
      {"size", {row.size.width, row.size.height}},
      {"camera", row.camera},
      {"light_scale", row.light_scale},
      {"camera_z", row.reversed_z ? "reversed" : "standard"},
      {"alias", row.alias},
      {"keep_all", row.keep_all},
      {"device", row.device.name},
      {"driver", row.device.driver},
      {"frame_ms", to_json(summarise(row.samples.frame_ms()))},
      {"record_ms", to_json(summarise(row.samples.record_ms()))},
      {"gpu_ms",
       {{"overlapped", gpu_of(row.samples.overlapped)}, {"isolated", gpu_of(row.samples.isolated)}}},
      {"passes", passes_of(row.samples)},
      {"error", row.error_json.empty() ? json(nullptr) : json::parse(row.error_json)},
      {"reference", row.error_json.empty() ? json(nullptr) : json{{"samples", row.reference_samples}}},
      {"light_samples", light_samples_of(row.facts)},
      {"memory",
       {{"limit_bytes", row.memory_limit},
        {"peak_bytes", row.memory.peak_bytes},
        {"transient_bytes", row.memory.transient_bytes},
        {"transient_bytes_without_aliasing", row.memory.transient_bytes_without_aliasing}}},
      {"left_out", left_out_of(row.left_out)},
      {"nonfinite", row.nonfinite},
      {"ratio", ratio_of(row.ratio)},
      {"warnings", row.warnings},
      {"facts", row.facts},
      {"status", row.status}};
  if (!row.harness_seconds.empty()) object["harness_seconds"] = row.harness_seconds;
  if (!row.images.empty()) object["images"] = row.images;
  if (row.sequence) object.update(to_json(*row.sequence));
  if (!row.key.empty()) object["key"] = row.key;
  return object;
}

}  // namespace gnomon
