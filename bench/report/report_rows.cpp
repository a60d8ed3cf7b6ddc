// Reads the rows of results.jsonl for reports and comparisons.
#include "bench/report/report_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/run/results.h"
#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path results_of(const fs::path& place) {
  return fs::is_directory(place) ? place / "results.jsonl" : place;
}

// Less is better in every one of the report's figures.
double less_is_better(const std::string& metric, double value) {
  if (metric == "ssim") return 1 - value;
  return metric == "bias" ? std::abs(value) : value;
}

std::optional<ErrorFigure> over_frames(const json& frames, const std::string& metric) {
  std::vector<double> values;
  for (const json& frame : frames)
    if (const auto value = figure_at(frame, "/error/" + metric))
      values.push_back(less_is_better(metric, *value));
  if (values.empty()) return std::nullopt;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  double sum = 0;
  for (const double value : values) sum += value;
  return ErrorFigure{sum / static_cast<double>(values.size()), *low, *high};
}

}  // namespace

bool is_ok(const json& row) {
  const auto status = row.find("status");
  return status != row.end() && *status == "ok";
}

std::vector<ReportRow> merge_results(const std::vector<fs::path>& places) {
  std::vector<ReportRow> merged;
  std::map<std::string, size_t> by_key;
  for (const fs::path& place : places) {
    const fs::path file = results_of(place);
    for (json& row : read_results(file)) {
      const auto found = row.find("key");
      const std::string key = found != row.end() && found->is_string() ? found->get<std::string>() : "";
      const auto known = key.empty() ? by_key.end() : by_key.find(key);
      if (known == by_key.end()) {
        if (!key.empty()) by_key[key] = merged.size();
        merged.push_back({std::move(row), file.parent_path()});
      } else if (is_ok(row) || !is_ok(merged[known->second].row)) {
        merged[known->second] = {std::move(row), file.parent_path()};
      }
    }
  }
  if (merged.empty()) fail("there are no results", places.empty() ? "" : results_of(places.front()).string());
  return merged;
}

std::optional<double> figure_at(const json& row, const std::string& pointer) {
  const json::json_pointer at(pointer);
  if (!row.contains(at) || !row.at(at).is_number()) return std::nullopt;
  const double value = row.at(at).get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string value_text(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string light_scale_text(const json& row) {
  const double scale = figure_at(row, "/light_scale").value_or(1);
  return scale == 1 ? "" : fmt::format(", light scale {:g}", scale);
}

std::string row_label(const json& row) {
  std::string text = row.contains("graph") ? value_text(row["graph"]) : "?";
  const auto set = row.find("set");
  if (set == row.end() || !set->is_object()) return text;
  for (const auto& [name, value] : set->items()) text += fmt::format(" {}={}", name, value_text(value));
  return text;
}

const std::vector<std::string>& error_metrics() {
  static const std::vector<std::string> names = {
      "rmse", "mae",         "misclassified", "wrongly_lit", "wrongly_shadowed",
      "leak", "umbra_light", "over_shadow",   "acne",        "penumbra_rmse",
      "flip", "ssim",        "flicker",       "max",         "bias"};
  return names;
}

std::optional<ErrorFigure> error_of(const json& row, const std::string& metric) {
  if (const auto frames = row.find("frames"); frames != row.end() && frames->is_array())
    if (const auto figure = over_frames(*frames, metric)) return figure;
  const auto value = figure_at(row, "/error/" + metric);
  if (!value) return std::nullopt;
  const double error = less_is_better(metric, *value);
  const auto low = figure_at(row, "/error/ci95/" + metric + "/0");
  const auto high = figure_at(row, "/error/ci95/" + metric + "/1");
  if (!low || !high) return ErrorFigure{error, error, error};
  const auto [least, most] = std::minmax({less_is_better(metric, *low), less_is_better(metric, *high)});
  const bool around_zero = *low < 0 && *high > 0;  // of the bias, whose magnitude is shown
  return ErrorFigure{error, around_zero ? 0 : least, most};
}

}  // namespace gnomon
