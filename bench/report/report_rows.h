// Rows of results.jsonl as reports and comparisons read them.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

struct ReportRow {
  nlohmann::json row;
  std::filesystem::path folder;  // that its images are relative to
};

// The rows of one or several runs: each of `places` is a results.jsonl or a folder that holds one. Of rows
// with the same "key" (shards, repeated runs) there is one, at the place of the first: the latest whose
// status is "ok", else the latest. Error: a file is missing or broken, or there is no row at all.
std::vector<ReportRow> merge_results(const std::vector<std::filesystem::path>& places);

bool is_ok(const nlohmann::json& row);
// A number at a JSON pointer, when it is there and finite.
std::optional<double> figure_at(const nlohmann::json& row, const std::string& pointer);
// "pcf kernel=15 shadow_map=512": the graph and what was set.
std::string row_label(const nlohmann::json& row);
// ", light scale 0.5"; nothing where the lights are as in the scene.
std::string light_scale_text(const nlohmann::json& row);
// Text of a variable's value, as after --set.
std::string value_text(const nlohmann::json& value);

// Names of the metrics in which less is better, in the order of choice: rmse, mae, misclassified, ...
const std::vector<std::string>& error_metrics();
// Of a sequence the mean over its frames, with their range.
struct ErrorFigure {
  double value = 0, low = 0, high = 0;
};
// A row's error by `metric`, 0 = none: of `ssim` it is 1 - SSIM, of `bias` its magnitude. Absent when the row
// has no such figure.
std::optional<ErrorFigure> error_of(const nlohmann::json& row, const std::string& metric);

}  // namespace gnomon
