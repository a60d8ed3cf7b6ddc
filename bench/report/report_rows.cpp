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

fs::path results_of(const fs::path& place) {
  return fs::is_directory(place) ? place / "results.jsonl" : place;
}

// Less is better in every one of the report's figures.
double less_is_better(const std::string& metric, double value) {
  if (metric == "ssim") return 1 - value;
  return metric == "bias" ? std::abs(value) : value;
}

std::optional<ErrorFigure> over_frames(const Row& row, const std::string& metric) {
  std::vector<double> values;
  for (const FrameResult& frame : row.frames)
    if (const auto value = figure_of(frame.error, metric)) values.push_back(less_is_better(metric, *value));
  if (values.empty()) return std::nullopt;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  double sum = 0;
  for (const double value : values) sum += value;
  return ErrorFigure{sum / static_cast<double>(values.size()), *low, *high};
}

}  // namespace

std::vector<ReportRow> merge_results(const std::vector<fs::path>& places) {
  std::vector<ReportRow> merged;
  std::map<std::string, size_t> by_key;
  for (const fs::path& place : places) {
    const fs::path file = results_of(place);
    for (Row& row : read_results(file)) {
      const auto known = row.key.empty() ? by_key.end() : by_key.find(row.key);
      if (known == by_key.end()) {
        if (!row.key.empty()) by_key[row.key] = merged.size();
        merged.push_back({std::move(row), file.parent_path()});
      } else if (row.ok() || !merged[known->second].row.ok()) {
        merged[known->second] = {std::move(row), file.parent_path()};
      }
    }
  }
  if (merged.empty()) fail("there are no results", places.empty() ? "" : results_of(places.front()).string());
  return merged;
}

std::optional<double> frame_ms_of(const Row& row) {
  return row.frame_ms && std::isfinite(row.frame_ms->median) ? std::optional(row.frame_ms->median)
                                                             : std::nullopt;
}

std::string light_scale_text(const Row& row) {
  return row.light_scale == 1 ? "" : fmt::format(", light scale {:g}", row.light_scale);
}

std::optional<ErrorFigure> error_of(const Row& row, const std::string& metric) {
  if (const auto figure = over_frames(row, metric)) return figure;
  const auto value = figure_of(row.error, metric);
  if (!value) return std::nullopt;
  const double error = less_is_better(metric, *value);
  if (!row.error->intervals || !row.error->intervals->contains(metric))
    return ErrorFigure{error, error, error};
  const auto [low, high] = row.error->intervals->at(metric);
  const auto [least, most] = std::minmax({less_is_better(metric, low), less_is_better(metric, high)});
  const bool around_zero = low < 0 && high > 0;  // of the bias, whose magnitude is shown
  return ErrorFigure{error, around_zero ? 0 : least, most};
}

}  // namespace gnomon
