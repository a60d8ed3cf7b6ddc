// Makes a report of one HTML file that needs nothing else.
#include "tools/report_page.h"

#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/input_file.h"
#include "engine/base/resource_root.h"
#include "engine/image/image.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kPackagedCharts = "/usr/share/javascript/chart.js/chart.min.js";  // libjs-chart.js

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
    places = {resource_root() / "tools" / "report" / "chart.min.js", kPackagedCharts};
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

namespace {

// The bytes of an image file; empty when it holds something else.
std::string image_bytes(const fs::path& file) {
  try {
    read_image(file);
    return read_input_file(file);
  } catch (const Error&) {
    return {};
  }
}

// Images as data URIs, each once.
class Embedded {
 public:
  explicit Embedded(uint64_t budget) : budget_(budget) {}

  // Its index; nothing when it is no image, or does not fit any more.
  std::optional<size_t> add(const std::string& path) {
    if (const auto known = index_.find(path); known != index_.end()) return known->second;
    std::error_code error;
    if (used_ + fs::file_size(path, error) > budget_ || error) return ++over_, std::nullopt;
    const std::string bytes = image_bytes(path);
    if (bytes.empty()) return std::nullopt;
    used_ += bytes.size();
    images_.push_back("data:image/png;base64," + base64(bytes));
    return index_.emplace(path, images_.size() - 1).first->second;
  }
  json take() { return std::move(images_); }
  uint64_t over() const { return over_; }

 private:
  const uint64_t budget_;
  uint64_t used_ = 0, over_ = 0;
  json images_ = json::array();
  std::map<std::string, size_t> index_;  // by path
};

}  // namespace

void embed_images(json& report, uint64_t budget) {
  Embedded embedded(budget);
  uint64_t named = 0, shown = 0;
  for (const json& row : report["rows"]) named += row.value("images_named", uint64_t{0});
  for (const char* kind : {"reference", "domain", "visibility", "reference_color", "color"}) {
    for (json& row : report["rows"]) {
      json& images = row["images"];
      if (!images.contains(kind) || !images[kind].is_string()) continue;
      const auto index = embedded.add(images[kind]);
      images.erase(kind);
      if (!index) continue;
      images[kind] = *index;
      ++shown;
    }
  }
  report["images_left_out"] = embedded.over();
  report["images_refused"] = named - shown - embedded.over();
  report["images"] = embedded.take();
}

std::string report_page(const json& report) {
  const fs::path folder = resource_root() / "tools" / "report";
  std::string page = read_input_file(folder / "report.html");
  fill(page, "/*gnomon:style*/", read_input_file(folder / "report.css"));
  fill(page, "/*gnomon:charts*/", in_script(read_input_file(chart_library())));
  std::string script;
  for (const char* file : {"marks.js", "images.js", "report.js"}) script += read_input_file(folder / file);
  fill(page, "/*gnomon:script*/", in_script(script));
  fill(page, "{\"gnomon\":\"data\"}", json_in_script(report));
  return page;
}

}  // namespace gnomon
