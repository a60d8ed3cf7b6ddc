// The rows of a report as a table for spreadsheets.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/report/report_data.h"
#include "bench/report/report_figure.h"

namespace gnomon {
namespace {

using nlohmann::json;

// A spreadsheet would take text that begins like this for a formula.
bool looks_like_a_formula(const std::string& text) {
  return !text.empty() && std::string("=+-@\t\r").find(text.front()) != std::string::npos;
}

std::string quoted(const std::string& text) {
  const std::string harmless = looks_like_a_formula(text) ? "'" + text : text;
  if (harmless == text && text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : harmless) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

std::string csv_text(const json& value) {
  if (value.is_null()) return {};
  return quoted(value_text(value));
}

std::string number_at(const json& from, const std::string& pointer) {
  const auto value = figure_at(from, pointer);
  return value ? fmt::format("{}", *value) : std::string();
}

std::string header_of(const json& report) {
  std::string text =
      "scene,width,height,light_scale,device,technique,label,baseline,ms,ms_low,ms_high,ratio,ratio_low,"
      "ratio_high,steady_ms,steady_ms_low,steady_ms_high,peak_bytes";
  for (const json& metric : report["metrics"])
    text += fmt::format(",{0},{0}_low,{0}_high", csv_text(metric["name"]));
  return text + ",pareto\r\n";
}

std::string line_of(const json& row, const json& place, const json& metrics) {
  std::vector<std::string> cells = {csv_text(place["scene"]),    number_at(place, "/size/0"),
                                    number_at(place, "/size/1"), number_at(place, "/light_scale"),
                                    csv_text(place["device"]),   csv_text(row["technique"]),
                                    csv_text(row["label"]),      row["baseline"].dump()};
  for (const char* time : {"/ms", "/ratio", "/steady_ms"})
    for (const char* figure : {"/median", "/low", "/high"})
      cells.push_back(number_at(row, std::string(time) + figure));
  cells.push_back(number_at(row, "/peak_bytes"));
  std::string fronts;
  for (const json& metric : metrics) {
    const std::string name = metric["name"];
    for (const char* figure : {"/value", "/low", "/high"})
      cells.push_back(number_at(row, "/errors/" + name + figure));
    const json& front = place["fronts"][name];
    if (std::find(front.begin(), front.end(), row["id"]) != front.end())
      fronts += (fronts.empty() ? "" : " ") + name;
  }
  cells.push_back(fronts);
  return fmt::format("{}\r\n", fmt::join(cells, ","));
}

}  // namespace

std::string report_csv(const json& report) {
  std::string text = header_of(report);
  for (const json& row : report["rows"])
    text += line_of(row, report["places"][row["place"].get<size_t>()], report["metrics"]);
  return text;
}

}  // namespace gnomon
