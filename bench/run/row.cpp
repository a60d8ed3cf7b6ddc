// Fills in a row: times of passes, and what graph and renderer say of themselves.
#include "bench/run/row.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/base/config.h"

namespace gnomon {
namespace {

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

std::optional<Summary> summary_of(const std::vector<double>& samples) {
  return samples.empty() ? std::nullopt : std::optional(summarise(samples));
}

std::vector<PassFigures> passes_of(const Samples& samples) {
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
  std::vector<PassFigures> passes;
  for (const auto& [key, pass] : table.entries())
    passes.push_back({key.first,
                      pass.type,
                      key.second,
                      {summary_of(pass.gpu_overlapped), summary_of(pass.gpu_isolated)},
                      median(pass.cpu),
                      median(pass.wait)});
  return passes;
}

std::optional<Summary> gpu_of(const std::vector<FrameTiming>& frames) {
  std::vector<double> values;
  values.reserve(frames.size());
  for (const FrameTiming& frame : frames) values.push_back(frame.gpu_ms);
  return summary_of(values);
}

// Techniques that sample an area light say with how many samples; every other one uses the light's centre.
double light_samples_of(const std::map<std::string, double>& facts) {
  for (const auto& [name, value] : facts)
    if (name == "light_samples" || name.ends_with(".light_samples")) return value;
  return 1;
}

}  // namespace

const char* version() { return GNOMON_VERSION; }

void set_scene(Row& row, const std::filesystem::path& file) {
  row.scene = file.stem().string();
  row.scene_file = file;
}

void describe_graph(Row& row, const Graph& graph) {
  row.graph = graph.name;
  row.graph_file = graph.file;
  row.graph_hash = canonical_hash(to_json(graph));
  row.vars = graph.vars;
}

void describe_renderer(Row& row, const Renderer& renderer) {
  row.memory.use = renderer.memory();
  row.left_out = renderer.left_out();
  row.warnings = renderer.warnings();
  row.facts = renderer.facts();
  row.light_samples = light_samples_of(row.facts);
}

void describe_samples(Row& row, const Samples& samples) {
  row.frame_ms = summary_of(samples.frame_ms());
  row.record_ms = summary_of(samples.record_ms());
  row.gpu_ms = {gpu_of(samples.overlapped), gpu_of(samples.isolated)};
  row.passes = passes_of(samples);
}

void describe_sequence(Row& row, const SequenceResult& result) {
  row.frames = result.frames();
  row.sequence = SequenceFigures{result.frames().size(), result.rmse(), result.flicker()};
  row.flicker = row.sequence->flicker ? std::optional(row.sequence->flicker->mean) : std::nullopt;
}

uint64_t count_nonfinite(const Image& image) {
  return static_cast<uint64_t>(
      std::count_if(image.data.begin(), image.data.end(), [](float x) { return !std::isfinite(x); }));
}

std::string label_of(const std::string& graph, const Values& set) {
  std::string text = graph;
  for (const auto& [name, value] : set) text += " " + name + "=" + to_string(value);
  return text;
}

std::string label_of(const Row& row) { return label_of(row.graph, row.set); }

const std::vector<std::string>& error_metrics() {
  static const std::vector<std::string> names = {
      "rmse", "mae",         "misclassified", "wrongly_lit", "wrongly_shadowed",
      "leak", "umbra_light", "over_shadow",   "acne",        "penumbra_rmse",
      "flip", "ssim",        "flicker",       "max",         "bias"};
  return names;
}

}  // namespace gnomon
