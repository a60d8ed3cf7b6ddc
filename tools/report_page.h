// A report as one HTML file that needs nothing else.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace gnomon {

// Chart.js: the file GNOMON_CHARTS names, else tools/report/chart.min.js under resource_root(), else that of
// the system's package. Error when there is none.
std::filesystem::path chart_library();

// Puts the images that `report` (bench/report/report_data.h) names into it as data URIs, and their paths out
// of it, as long as they fit into `budget` bytes of files: references and visibilities before colours.
// `report`'s "images_left_out" counts those that do not fit, "images_refused" those that are no image files
// of their run.
void embed_images(nlohmann::json& report, uint64_t budget);

// The template, styles and scripts of tools/report, the chart library and `report` in one page.
std::string report_page(const nlohmann::json& report);

std::string base64(const std::string& bytes);  // RFC 4648, padded

}  // namespace gnomon
