// What a report shows, computed from result rows.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/report/report_rows.h"

namespace gnomon {

// The content of report.json:
//   metrics  [{name, definition, unit}]  those that some row has; less is better in each
//   places   [{scene, size, camera, light_scale, device, driver, samples, frames, baseline, rows: [id],
//   fronts: {metric: [id]}, steady_fronts: {metric: [id]}}]
//            what can be compared with one another; `fronts`: the Pareto fronts of that metric and `ms`, and
//            of that metric and `steady_ms`
//   rows     [{id, place, technique, label, baseline, ms, steady_ms, ratio, ratio_to, errors: {metric:
//   {value, low, high}},
//             passes: [{id, type, ms}], rest_ms, peak_bytes, left_out, warnings, images, vars, set, key}]
//            `steady_ms`: ratio x the median of the baseline `ratio_to`, so that rows measured at different
//            times can be compared though the machine became slower or quicker between them; `ms` where there
//            is no ratio
//   sweeps   [{scene, technique, parameter, fixed, rows: [id], x: [..], ms: fit, errors: {metric: fit}}]
//            rows that differ in one numeric variable, in the output's size (`output_pixels`), or in the
//            lights' (`light_scale`), only; a fit is {exponent, factor, r2, n} or null
//   failed   [{label, scene, size, status}]
// Paths of images are absolute: `folder` of the row and what the row says.
nlohmann::json report_data(const std::vector<ReportRow>& rows);

// One line per row of report_data(): scene, size, technique, variables, times, errors. RFC 4180; text that a
// spreadsheet would take for a formula begins with an apostrophe.
std::string report_csv(const nlohmann::json& report);

}  // namespace gnomon
