// What a report shows: rows, what can be compared with one another, and the Pareto fronts.
#include "bench/report/report_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/report/pareto.h"
#include "bench/report/report_image_files.h"
#include "bench/report/report_sweeps.h"
#include "engine/truth/metrics.h"

namespace gnomon {
namespace {

using nlohmann::json;

// Rows with the same place saw the same pixels on the same device.
json place_of(const Row& row) {
  return {{"scene", row.scene},
          {"size", {row.size.width, row.size.height}},
          {"camera", row.camera},
          {"light_scale", row.light_scale},
          {"device", row.device.name},
          {"driver", row.device.driver},
          {"samples", row.reference ? json(row.reference->samples) : json()},
          {"frames", row.sequence ? json(row.sequence->frames) : json()}};
}

json interval_of(const std::optional<Summary>& summary) {
  if (!summary || !std::isfinite(summary->median)) return nullptr;
  return {{"median", summary->median}, {"low", summary->low}, {"high", summary->high}, {"n", summary->n}};
}

json errors_of(const Row& row) {
  json errors = json::object();
  for (const std::string& metric : error_metrics())
    if (const auto error = error_of(row, metric))
      errors[metric] = {{"value", error->value}, {"low", error->low}, {"high", error->high}};
  return errors;
}

// Passes in their order, iterations of a loop added up.
json passes_of(const Row& row) {
  json passes = json::array();
  std::map<std::string, size_t> known;
  for (const PassFigures& pass : row.passes) {
    const auto& ms = pass.gpu_ms.overlapped ? pass.gpu_ms.overlapped : pass.gpu_ms.isolated;
    if (!ms || !std::isfinite(ms->median)) continue;
    const auto [found, is_new] = known.emplace(pass.id, passes.size());
    if (is_new)
      passes.push_back({{"id", pass.id}, {"type", pass.type}, {"ms", ms->median}});
    else
      passes[found->second]["ms"] = passes[found->second]["ms"].get<double>() + ms->median;
  }
  return passes;
}

// By kind: where they are. What is no image file of the run is left out.
json images_of(const ReportRow& source) {
  json images = json::object();
  for (const auto& [kind, name] : source.row.images)
    if (const auto file = image_below(source.folder, name)) images[kind] = file->string();
  return images;
}

json left_out_of(const Row& row) {
  json passes = json::array();
  for (const LeftOutPass& pass : row.left_out)
    passes.push_back({{"pass", pass.pass}, {"part", pass.part}, {"reason", pass.reason}});
  return passes;
}

json row_of(const ReportRow& source) {
  const Row& row = source.row;
  json passes = passes_of(row);
  double in_passes = 0;
  for (const json& pass : passes) in_passes += pass["ms"].get<double>();
  const auto ms = frame_ms_of(row);
  const double rest = !ms || passes.empty() ? 0 : std::max(0.0, *ms - in_passes);
  return {{"technique", row.graph},
          {"label", label_of(row)},
          {"baseline", row.is_baseline},
          {"ms", interval_of(row.frame_ms)},
          {"ratio", interval_of(row.ratio ? std::optional(row.ratio->value) : std::nullopt)},
          {"ratio_to", row.ratio ? json(row.ratio->baseline) : json()},
          {"errors", errors_of(row)},
          {"passes", std::move(passes)},
          {"rest_ms", rest},
          {"peak_bytes", row.memory.use.peak_bytes > 0 ? json(row.memory.use.peak_bytes) : json()},
          {"left_out", left_out_of(row)},
          {"warnings", row.warnings},
          {"images", images_of(source)},
          {"images_named", source.row.images.size()},
          {"vars", to_json(row.vars)},
          {"set", to_json(row.set)},
          {"key", row.key.empty() ? json() : json(row.key)}};
}

json metrics_of(const json& rows) {
  json metrics = json::array();
  for (const std::string& name : error_metrics()) {
    const bool there =
        std::any_of(rows.begin(), rows.end(), [&](const json& row) { return row["errors"].contains(name); });
    if (!there) continue;
    json metric = {{"name", name}, {"title", name}, {"definition", ""}, {"unit", ""}};
    if (name == "ssim") metric["title"] = "1 - ssim";
    if (name == "bias") metric["title"] = "|bias|";
    for (const MetricInfo& info : metric_infos())
      if (info.name == name) metric["definition"] = info.definition, metric["unit"] = info.unit;
    metrics.push_back(std::move(metric));
  }
  return metrics;
}

// What the row would have taken had the machine been as it was for the baseline: the ratio, which rounds of
// the same moment gave, times the baseline's median. `ms` where there is no ratio or baseline.
json steady_ms_of(const json& row, const json& rows, const std::vector<size_t>& ids) {
  if (row["baseline"] == true || row["ratio"].is_null()) return row["ms"];
  for (const size_t id : ids) {
    const json& other = rows[id];
    if (other["baseline"] != true || other["label"] != row["ratio_to"]) continue;
    if (other["ms"].is_null()) continue;
    const double scale = other["ms"]["median"];
    json steady = row["ratio"];
    for (const char* name : {"median", "low", "high"}) steady[name] = scale * steady[name].get<double>();
    return steady;
  }
  return row["ms"];
}

// `time`: "ms" or "steady_ms".
json front_of(const json& rows, const std::vector<size_t>& ids, const std::string& metric, const char* time) {
  std::vector<TimeAndError> candidates;
  std::vector<size_t> of;
  for (const size_t id : ids) {
    if (rows[id][time].is_null() || !rows[id]["errors"].contains(metric)) continue;
    candidates.push_back({rows[id][time]["median"], rows[id]["errors"][metric]["value"]});
    of.push_back(id);
  }
  json front = json::array();
  for (const size_t i : pareto_front(candidates)) front.push_back(of[i]);
  return front;
}

json places_of(json& rows, const std::vector<json>& keys, const json& metrics) {
  std::vector<json> places;
  std::vector<std::vector<size_t>> members;
  for (size_t id = 0; id < rows.size(); ++id) {
    const auto found = std::find(places.begin(), places.end(), keys[id]);
    const auto place = static_cast<size_t>(found - places.begin());
    if (found == places.end()) places.push_back(keys[id]), members.emplace_back();
    members[place].push_back(id);
    rows[id]["place"] = place;
  }
  for (size_t i = 0; i < places.size(); ++i) {
    for (const size_t id : members[i]) rows[id]["steady_ms"] = steady_ms_of(rows[id], rows, members[i]);
    json fronts = json::object(), steady_fronts = json::object();
    for (const json& metric : metrics) {
      const std::string name = metric["name"];
      fronts[name] = front_of(rows, members[i], name, "ms");
      steady_fronts[name] = front_of(rows, members[i], name, "steady_ms");
    }
    places[i]["rows"] = members[i];
    places[i]["fronts"] = std::move(fronts);
    places[i]["steady_fronts"] = std::move(steady_fronts);
  }
  return places;
}

}  // namespace

json report_data(const std::vector<ReportRow>& sources) {
  json rows = json::array(), failed = json::array();
  std::vector<json> places;
  for (const ReportRow& source : sources) {
    if (!source.row.ok()) {
      failed.push_back({{"label", label_of(source.row)},
                        {"scene", source.row.scene},
                        {"size", {source.row.size.width, source.row.size.height}},
                        {"status", source.row.status}});
      continue;
    }
    json row = row_of(source);
    row["id"] = rows.size();
    places.push_back(place_of(source.row));
    rows.push_back(std::move(row));
  }
  const json metrics = metrics_of(rows);
  json sweeps = sweeps_of(rows, places, metrics);
  json grouped = places_of(rows, places, metrics);
  return {{"schema", 1},
          {"gnomon", version()},
          {"metrics", metrics},
          {"places", std::move(grouped)},
          {"rows", std::move(rows)},
          {"sweeps", std::move(sweeps)},
          {"failed", failed}};
}

}  // namespace gnomon
