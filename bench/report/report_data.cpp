// Computes what a report shows from result rows: the content of report.json.
#include "bench/report/report_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/report/pareto.h"
#include "bench/report/report_fit.h"
#include "bench/run/run_json.h"
#include "engine/truth/metrics.h"

namespace gnomon {
namespace {

using nlohmann::json;

json field(const json& row, const char* name) {
  const auto found = row.find(name);
  return found == row.end() ? json() : *found;
}

// Rows with the same place saw the same pixels on the same device.
json place_of(const json& row) {
  const auto samples = figure_at(row, "/reference/samples");
  const auto frames = figure_at(row, "/sequence/frames");
  return {{"scene", field(row, "scene")},
          {"size", field(row, "size")},
          {"camera", field(row, "camera")},
          {"light_scale", figure_at(row, "/light_scale").value_or(1)},
          {"device", field(row, "device")},
          {"driver", field(row, "driver")},
          {"samples", samples ? json(*samples) : json()},
          {"frames", frames ? json(*frames) : json()}};
}

json interval_at(const json& row, const std::string& pointer) {
  const auto median = figure_at(row, pointer + "/median");
  if (!median) return nullptr;
  const double low = figure_at(row, pointer + "/ci95/0").value_or(*median);
  const double high = figure_at(row, pointer + "/ci95/1").value_or(*median);
  return {
      {"median", *median}, {"low", low}, {"high", high}, {"n", figure_at(row, pointer + "/n").value_or(1)}};
}

json errors_of(const json& row) {
  json errors = json::object();
  for (const std::string& metric : error_metrics())
    if (const auto error = error_of(row, metric))
      errors[metric] = {{"value", error->value}, {"low", error->low}, {"high", error->high}};
  return errors;
}

// Passes in their order, iterations of a loop added up.
json passes_of(const json& row) {
  json passes = json::array();
  std::map<std::string, size_t> known;
  const json rows = field(row, "passes");
  if (!rows.is_array()) return passes;
  for (const json& pass : rows) {
    auto ms = figure_at(pass, "/gpu_ms/overlapped/median");
    if (!ms) ms = figure_at(pass, "/gpu_ms/isolated/median");
    if (!ms) continue;
    const std::string id = value_text(field(pass, "id"));
    const auto [found, is_new] = known.emplace(id, passes.size());
    if (is_new)
      passes.push_back({{"id", id}, {"type", field(pass, "type")}, {"ms", *ms}});
    else
      passes[found->second]["ms"] = passes[found->second]["ms"].get<double>() + *ms;
  }
  return passes;
}

json images_of(const ReportRow& source) {
  json images = json::object();
  const json given = field(source.row, "images");
  if (given.is_object())
    for (const auto& [name, path] : given.items())
      if (path.is_string())
        images[name] =
            std::filesystem::absolute(source.folder / path.get<std::string>()).lexically_normal().string();
  return images;
}

bool is_baseline(const json& row) {
  return figure_at(row, "/ratio/median") == 1.0 && figure_at(row, "/ratio/mad") == 0.0 &&
         value_text(json(row.value("/ratio/baseline"_json_pointer, "")))
             .starts_with(value_text(field(row, "graph")));
}

json row_of(const ReportRow& source) {
  const json& row = source.row;
  json passes = passes_of(row);
  double in_passes = 0;
  for (const json& pass : passes) in_passes += pass["ms"].get<double>();
  const json ms = interval_at(row, "/frame_ms");
  const double rest =
      ms.is_null() || passes.empty() ? 0 : std::max(0.0, ms["median"].get<double>() - in_passes);
  return {{"technique", field(row, "graph")},
          {"label", row_label(row)},
          {"baseline", is_baseline(row)},
          {"ms", ms},
          {"ratio", interval_at(row, "/ratio")},
          {"ratio_to", row.value("/ratio/baseline"_json_pointer, json())},
          {"errors", errors_of(row)},
          {"passes", std::move(passes)},
          {"rest_ms", rest},
          {"peak_bytes", row.value("/memory/peak_bytes"_json_pointer, json())},
          {"left_out", field(row, "left_out").is_array() ? row["left_out"] : json::array()},
          {"warnings", field(row, "warnings").is_array() ? row["warnings"] : json::array()},
          {"images", images_of(source)},
          {"vars", field(row, "vars")},
          {"set", field(row, "set")},
          {"key", field(row, "key")}};
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
    const auto scale = figure_at(other, "/ms/median");
    if (!scale) continue;
    json steady = row["ratio"];
    for (const char* name : {"median", "low", "high"}) steady[name] = *scale * steady[name].get<double>();
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

json fit(const std::vector<double>& x, const std::vector<std::optional<double>>& y) {
  std::vector<double> there_x, there_y;
  for (size_t i = 0; i < x.size(); ++i)
    if (y[i]) there_x.push_back(x[i]), there_y.push_back(*y[i]);
  const auto law = fit_power_law(there_x, there_y);
  if (!law) return nullptr;
  return {{"exponent", law->exponent}, {"factor", law->factor}, {"r2", law->r2}, {"n", law->n}};
}

// Parameters of a place, and the member that they are made of; all others are variables of the graph.
const std::map<std::string, std::string>& place_parameters() {
  static const std::map<std::string, std::string> parameters = {{"output_pixels", "size"},
                                                                {"light_scale", "light_scale"}};
  return parameters;
}

std::optional<double> parameter_of(const json& row, const json& place, const std::string& name) {
  if (place_parameters().count(name) == 0) return figure_at(row, "/vars/" + name);
  if (name == "light_scale") return figure_at(place, "/light_scale");
  const auto width = figure_at(place, "/size/0"), height = figure_at(place, "/size/1");
  return width && height ? std::optional(*width * *height) : std::nullopt;
}

// All that must be equal for two rows to differ in `parameter` only.
json others_of(const json& row, json place, const std::string& parameter) {
  json vars = row["vars"].is_object() ? row["vars"] : json::object();
  const auto of_place = place_parameters().find(parameter);
  if (of_place != place_parameters().end())
    place.erase(of_place->second);
  else
    vars.erase(parameter);
  return {place, row["technique"], vars};
}

std::string fixed_text(const json& row, const json& place, const std::string& parameter) {
  std::vector<std::string> parts;
  if (parameter != "output_pixels" && place["size"].is_array() && place["size"].size() == 2)
    parts.push_back(fmt::format("{}x{}", place["size"][0].dump(), place["size"][1].dump()));
  if (parameter != "light_scale" && place["light_scale"] != 1)
    parts.push_back(fmt::format("light_scale={}", value_text(place["light_scale"])));
  if (row["set"].is_object())
    for (const auto& [name, value] : row["set"].items())
      if (name != parameter) parts.push_back(fmt::format("{}={}", name, value_text(value)));
  return fmt::format("{}", fmt::join(parts, " "));
}

json sweep(const json& rows, const json& place, const std::string& parameter, std::vector<size_t> ids,
           const json& metrics) {
  const auto x_of = [&](size_t id) { return *parameter_of(rows[id], rows[id]["_place"], parameter); };
  std::stable_sort(ids.begin(), ids.end(), [&](size_t a, size_t b) { return x_of(a) < x_of(b); });
  ids.erase(std::unique(ids.begin(), ids.end(), [&](size_t a, size_t b) { return x_of(a) == x_of(b); }),
            ids.end());
  if (ids.size() < 2) return nullptr;
  std::vector<double> x;
  std::vector<std::optional<double>> ms;
  for (const size_t id : ids) x.push_back(x_of(id)), ms.push_back(figure_at(rows[id], "/ms/median"));
  json errors = json::object();
  for (const json& metric : metrics) {
    const std::string name = metric["name"];
    std::vector<std::optional<double>> values;
    for (const size_t id : ids) values.push_back(figure_at(rows[id], "/errors/" + name + "/value"));
    errors[name] = fit(x, values);
  }
  return {{"scene", place["scene"]},
          {"technique", rows[ids.front()]["technique"]},
          {"parameter", parameter},
          {"fixed", fixed_text(rows[ids.front()], place, parameter)},
          {"rows", ids},
          {"x", x},
          {"ms", fit(x, ms)},
          {"errors", errors}};
}

json sweeps_of(const json& rows, const json& metrics) {
  std::set<std::string> names;
  for (const json& row : rows)
    if (row["vars"].is_object())
      for (const auto& [name, value] : row["vars"].items())
        if (value.is_number()) names.insert(name);
  std::vector<std::string> parameters(names.begin(), names.end());
  for (const auto& [name, member] : place_parameters()) parameters.insert(parameters.begin(), name);
  json sweeps = json::array();
  for (const std::string& parameter : parameters) {
    std::vector<json> groups;
    std::vector<std::vector<size_t>> members;
    for (size_t id = 0; id < rows.size(); ++id) {
      if (!parameter_of(rows[id], rows[id]["_place"], parameter)) continue;
      const json key = others_of(rows[id], rows[id]["_place"], parameter);
      const auto found = std::find(groups.begin(), groups.end(), key);
      const auto group = static_cast<size_t>(found - groups.begin());
      if (found == groups.end()) groups.push_back(key), members.emplace_back();
      members[group].push_back(id);
    }
    for (const std::vector<size_t>& ids : members)
      if (json one = sweep(rows, rows[ids.front()]["_place"], parameter, ids, metrics); !one.is_null())
        sweeps.push_back(std::move(one));
  }
  return sweeps;
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

std::string csv_text(const json& value) {
  if (value.is_null()) return {};
  return quoted(value_text(value));
}

}  // namespace

json report_data(const std::vector<ReportRow>& sources) {
  json rows = json::array(), failed = json::array();
  std::vector<json> places;
  for (const ReportRow& source : sources) {
    if (!is_ok(source.row)) {
      failed.push_back({{"label", row_label(source.row)},
                        {"scene", field(source.row, "scene")},
                        {"size", field(source.row, "size")},
                        {"status", field(source.row, "status")}});
      continue;
    }
    json row = row_of(source);
    row["id"] = rows.size();
    row["_place"] = place_of(source.row);
    places.push_back(row["_place"]);
    rows.push_back(std::move(row));
  }
  const json metrics = metrics_of(rows);
  json sweeps = sweeps_of(rows, metrics);
  for (json& row : rows) row.erase("_place");
  json grouped = places_of(rows, places, metrics);
  return {{"schema", 1},
          {"gnomon", version()},
          {"metrics", metrics},
          {"places", std::move(grouped)},
          {"rows", std::move(rows)},
          {"sweeps", std::move(sweeps)},
          {"failed", failed}};
}

std::string report_csv(const json& report) {
  std::string text =
      "scene,width,height,light_scale,device,technique,label,baseline,ms,ms_low,ms_high,ratio,ratio_low,"
      "ratio_high,"
      "steady_ms,steady_ms_low,steady_ms_high,peak_bytes";
  for (const json& metric : report["metrics"]) {
    const std::string name = csv_text(metric["name"]);
    text += fmt::format(",{0},{0}_low,{0}_high", name);
  }
  text += ",pareto\r\n";
  for (const json& row : report["rows"]) {
    const json& place = report["places"][row["place"].get<size_t>()];
    const auto at = [&](const json& from, const char* pointer) {
      const auto value = figure_at(from, pointer);
      return value ? fmt::format("{}", *value) : std::string();
    };
    std::vector<std::string> cells = {
        csv_text(place["scene"]),  at(place, "/size/0"),       at(place, "/size/1"),
        at(place, "/light_scale"), csv_text(place["device"]),  csv_text(row["technique"]),
        csv_text(row["label"]),    row["baseline"].dump(),     at(row, "/ms/median"),
        at(row, "/ms/low"),        at(row, "/ms/high"),        at(row, "/ratio/median"),
        at(row, "/ratio/low"),     at(row, "/ratio/high"),     at(row, "/steady_ms/median"),
        at(row, "/steady_ms/low"), at(row, "/steady_ms/high"), at(row, "/peak_bytes")};
    std::string fronts;
    for (const json& metric : report["metrics"]) {
      const std::string name = metric["name"];
      for (const char* figure : {"value", "low", "high"})
        cells.push_back(at(row, ("/errors/" + name + "/" + figure).c_str()));
      const json& front = place["fronts"][name];
      if (std::find(front.begin(), front.end(), row["id"]) != front.end())
        fronts += (fronts.empty() ? "" : " ") + name;
    }
    cells.push_back(fronts);
    text += fmt::format("{}\r\n", fmt::join(cells, ","));
  }
  return text;
}

}  // namespace gnomon
