// Makes a report of one HTML file that needs nothing else.
#include "tools/report_page.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/resource_root.h"
#include "engine/graph/graph.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* packaged_charts = "/usr/share/javascript/chart.js/chart.min.js";  // libjs-chart.js

std::string read_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail("cannot open a file of the report", file.string());
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

// Text that cannot end the script element it stands in.
std::string in_script(std::string text) {
  replace_all(text, "</script", "<\\/script");
  replace_all(text, "<!--", "<\\!--");
  return text;
}

// In JSON both characters stand inside strings only.
std::string json_in_script(const json& data) {
  std::string text = data.dump(-1, ' ', false, json::error_handler_t::replace);
  replace_all(text, "<", "\\u003c");
  return text;
}

void fill(std::string& page, const std::string& marker, const std::string& text) {
  const size_t at = page.find(marker);
  if (at == std::string::npos) fail("the report's template lacks " + marker);
  page.replace(at, marker.size(), text);
}

}  // namespace

fs::path chart_library() {
  std::vector<fs::path> places;
  if (const char* given = std::getenv("GNOMON_CHARTS"); given != nullptr && *given != '\0')
    places.emplace_back(given);
  else
    places = {resource_root() / "tools" / "report" / "chart.min.js", packaged_charts};
  for (const fs::path& place : places)
    if (fs::is_regular_file(place)) return place;
  fail("the chart library Chart.js is missing", places.back().string(), {},
       "install the package libjs-chart.js (tools/install-dependencies does), or set GNOMON_CHARTS to "
       "chart.min.js");
}

std::string base64(const std::string& bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  const auto byte = [&](size_t i) { return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U; };
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const uint32_t three = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (uint32_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63U];
  }
  return text;
}

void embed_images(json& report, uint64_t budget) {
  std::map<std::string, size_t> index;  // path -> entry of "images"
  json embedded = json::array();
  uint64_t used = 0, left_out = 0;
  for (const char* name : {"reference", "domain", "visibility", "reference_color", "color"}) {
    for (json& row : report["rows"]) {
      json& images = row["images"];
      if (!images.contains(name) || !images[name].is_string()) continue;
      const std::string path = images[name];
      images.erase(name);
      auto known = index.find(path);
      if (known == index.end()) {
        const std::string bytes = read_file(path);
        if (used + bytes.size() > budget) {
          ++left_out;
          continue;
        }
        used += bytes.size();
        known = index.emplace(path, embedded.size()).first;
        embedded.push_back("data:image/png;base64," + base64(bytes));
      }
      images[name] = known->second;
    }
  }
  report["images"] = std::move(embedded);
  report["images_left_out"] = left_out;
}

std::string report_page(const json& report) {
  const fs::path folder = resource_root() / "tools" / "report";
  std::string page = read_file(folder / "report.html");
  fill(page, "/*gnomon:style*/", read_file(folder / "report.css"));
  fill(page, "/*gnomon:charts*/", in_script(read_file(chart_library())));
  std::string script;
  for (const char* file : {"marks.js", "images.js", "report.js"}) script += read_file(folder / file);
  fill(page, "/*gnomon:script*/", in_script(script));
  fill(page, "{\"gnomon\":\"data\"}", json_in_script(report));
  return page;
}

}  // namespace gnomon
