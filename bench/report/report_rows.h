// Rows of results.jsonl as reports and comparisons read them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/run/row.h"

namespace gnomon {

struct ReportRow {
  Row row;
  std::filesystem::path folder;  // that its images are relative to
};

// The rows of one or several runs: each of `places` is a results.jsonl or a folder that holds one. Of rows
// with the same "key" (shards, repeated runs) there is one, at the place of the first: the latest whose
// status is "ok", else the latest. Error: a file is missing or broken, or there is no row at all.
std::vector<ReportRow> merge_results(const std::vector<std::filesystem::path>& places);

// Median of the frame's time, milliseconds; absent when it was not measured.
std::optional<double> frame_ms_of(const Row& row);
// ", light scale 0.5"; nothing where the lights are as in the scene.
std::string light_scale_text(const Row& row);

// Of a sequence the mean over its frames, with their range.
struct ErrorFigure {
  double value = 0, low = 0, high = 0;
};
// A row's error by `metric`, 0 = none: of `ssim` it is 1 - SSIM, of `bias` its magnitude. Absent when the row
// has no such figure.
std::optional<ErrorFigure> error_of(const Row& row, const std::string& metric);

}  // namespace gnomon
