// Rows to JSON and back: the names of a row's members, once.
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/error/error_fields.h"
#include "bench/run/row.h"
#include "engine/base/json_fields.h"

namespace gnomon {

template <class Io>
void fields(Io& io, typename Io::template Of<Summary>& summary) {
  if constexpr (Io::reads) summary.median = std::numeric_limits<double>::quiet_NaN();
  io("median", summary.median);
  io("mad", summary.mad);
  FieldPair ci95{summary.low, summary.high};
  if constexpr (Io::reads) ci95 = {summary.median, summary.median};
  io("ci95", ci95);
  if constexpr (Io::reads) {
    summary.low = ci95[0], summary.high = ci95[1];
    summary.n = 1;
  }
  io("n", summary.n);
}

template <class Io>
void fields(Io& io, typename Io::template Of<GpuTimes>& times) {
  io("overlapped", times.overlapped);
  io("isolated", times.isolated);
}

template <class Io>
void fields(Io& io, typename Io::template Of<PassFigures>& pass) {
  io("id", pass.id);
  io("type", pass.type);
  io("iteration", pass.iteration);
  io("gpu_ms", pass.gpu_ms);
  io("cpu_ms", pass.cpu_ms);
  io("host_wait_ms", pass.host_wait_ms);
}

template <class Io>
void fields(Io& io, typename Io::template Of<Ratio>& ratio) {
  io("baseline", ratio.baseline);
  fields(io, ratio.value);
}

template <class Io>
void fields(Io& io, typename Io::template Of<RowReference>& reference) {
  io("samples", reference.samples);
}

template <class Io>
void fields(Io& io, typename Io::template Of<RowMemory>& memory) {
  io("limit_bytes", memory.limit_bytes);
  io("peak_bytes", memory.use.peak_bytes);
  io("transient_bytes", memory.use.transient_bytes);
  io("transient_bytes_without_aliasing", memory.use.transient_bytes_without_aliasing);
}

template <class Io>
void fields(Io& io, typename Io::template Of<LeftOutPass>& left_out) {
  io("pass", left_out.pass);
  io("part", left_out.part);
  io("reason", left_out.reason);
}

template <class Io>
void fields(Io& io, typename Io::template Of<Spread>& spread) {
  io("mean", spread.mean);
  io("max", spread.max);
}

template <class Io>
void fields(Io& io, typename Io::template Of<SequenceFigures>& sequence) {
  io("frames", sequence.frames);
  io("rmse", sequence.rmse);
  io("flicker", sequence.flicker);
}

template <class Io>
void fields(Io& io, typename Io::template Of<FrameResult>& frame) {
  io("time", frame.seconds);
  io("frame_ms", frame.frame_ms);
  io.unless_empty("error", frame.error);
}

namespace {

// What was measured.
template <class Io>
void identity_fields(Io& io, typename Io::template Of<Row>& row) {
  io("gnomon", row.program);
  io.unless_empty("key", row.key);
  io("scene", row.scene);
  io("scene_file", row.scene_file);
  io("graph", row.graph);
  io("graph_file", row.graph_file);
  io("graph_hash", row.graph_hash);
  io("vars", row.vars);
  io("set", row.set);
  io("size", row.size);
  io("camera", row.camera);
  io("light_scale", row.light_scale);
  std::string camera_z = row.reversed_z ? "reversed" : "standard";
  io("camera_z", camera_z);
  if constexpr (Io::reads) row.reversed_z = camera_z != "standard";
  io("alias", row.alias);
  io("keep_all", row.keep_all);
  io("device", row.device.name);
  io("driver", row.device.driver);
}

template <class Io>
void sequence_fields(Io& io, typename Io::template Of<Row>& row) {
  if constexpr (!Io::reads)
    if (!row.sequence) return;
  io("frames", row.frames);
  io("sequence", row.sequence);
  io("flicker", row.flicker);
}

}  // namespace

template <class Io>
void fields(Io& io, typename Io::template Of<Row>& row) {
  if constexpr (Io::reads) row.status = "error: the row says nothing of its success";
  identity_fields(io, row);
  io("frame_ms", row.frame_ms);
  io("record_ms", row.record_ms);
  io("gpu_ms", row.gpu_ms);
  io("passes", row.passes);
  io("error", row.error);
  io("reference", row.reference);
  io("light_samples", row.light_samples);
  io("memory", row.memory);
  io("left_out", row.left_out);
  io("nonfinite", row.nonfinite);
  io("ratio", row.ratio);
  if constexpr (Io::reads) row.is_baseline = row.ratio && row.ratio->baseline == label_of(row);
  io("baseline", row.is_baseline);
  io("warnings", row.warnings);
  io("facts", row.facts);
  sequence_fields(io, row);
  io.unless_empty("harness_seconds", row.harness_seconds);
  io.unless_empty("images", row.images);
  io("status", row.status);
}

std::optional<double> figure_of(const MeasuredError& error, const std::string& metric) {
  FieldFinder finder(metric);
  fields(finder, error);
  return finder.found();
}

std::optional<double> figure_of(const std::optional<MeasuredError>& error, const std::string& metric) {
  return error ? figure_of(*error, metric) : std::nullopt;
}

nlohmann::json to_json(const Summary& summary) {
  return summary.n == 0 ? nlohmann::json() : FieldWriter::written(summary);
}
nlohmann::json to_json(const Values& values) { return FieldWriter::written(values); }
nlohmann::json to_json(const Row& row) { return FieldWriter::written(row); }

Row row_from(const nlohmann::json& object, const std::string& file, const std::string& line) {
  Row row;
  FieldReader reader(object, {file, line});
  fields(reader, row);
  return row;
}

}  // namespace gnomon
