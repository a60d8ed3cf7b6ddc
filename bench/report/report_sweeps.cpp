// Rows that differ in one parameter only, and the power laws that describe them.
#include "bench/report/report_sweeps.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "bench/report/report_figure.h"
#include "bench/report/report_fit.h"

namespace gnomon {
namespace {

using nlohmann::json;

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
  if (place_parameters().count(name) == 0) {
    const auto value = row["vars"].find(name);
    return value != row["vars"].end() && value->is_number() ? std::optional(value->get<double>())
                                                            : std::nullopt;
  }
  if (name == "light_scale") return figure_at(place, "/light_scale");
  const auto width = figure_at(place, "/size/0"), height = figure_at(place, "/size/1");
  return width && height ? std::optional(*width * *height) : std::nullopt;
}

// All that must be equal for two rows to differ in `parameter` only.
json others_of(const json& row, json place, const std::string& parameter) {
  json vars = row["vars"];
  const auto of_place = place_parameters().find(parameter);
  if (of_place != place_parameters().end())
    place.erase(of_place->second);
  else
    vars.erase(parameter);
  return {place, row["technique"], vars};
}

std::string fixed_text(const json& row, const json& place, const std::string& parameter) {
  std::vector<std::string> parts;
  if (parameter != "output_pixels")
    parts.push_back(fmt::format("{}x{}", place["size"][0].dump(), place["size"][1].dump()));
  if (parameter != "light_scale" && place["light_scale"] != 1)
    parts.push_back(fmt::format("light_scale={}", value_text(place["light_scale"])));
  for (const auto& [name, value] : row["set"].items())
    if (name != parameter) parts.push_back(fmt::format("{}={}", name, value_text(value)));
  return fmt::format("{}", fmt::join(parts, " "));
}

json sweep(const json& rows, const std::vector<json>& places, const std::string& parameter,
           std::vector<size_t> ids, const json& metrics) {
  const json& place = places[ids.front()];
  const auto x_of = [&](size_t id) { return *parameter_of(rows[id], places[id], parameter); };
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

// Names of the variables that are numbers in some row, and of the places' parameters.
std::vector<std::string> parameters_of(const json& rows) {
  std::set<std::string> names;
  for (const json& row : rows)
    for (const auto& [name, value] : row["vars"].items())
      if (value.is_number()) names.insert(name);
  std::vector<std::string> parameters(names.begin(), names.end());
  for (const auto& [name, member] : place_parameters()) parameters.insert(parameters.begin(), name);
  return parameters;
}

}  // namespace

json sweeps_of(const json& rows, const std::vector<json>& places, const json& metrics) {
  json sweeps = json::array();
  for (const std::string& parameter : parameters_of(rows)) {
    std::vector<json> groups;
    std::vector<std::vector<size_t>> members;
    for (size_t id = 0; id < rows.size(); ++id) {
      if (!parameter_of(rows[id], places[id], parameter)) continue;
      const json key = others_of(rows[id], places[id], parameter);
      const auto found = std::find(groups.begin(), groups.end(), key);
      const auto group = static_cast<size_t>(found - groups.begin());
      if (found == groups.end()) groups.push_back(key), members.emplace_back();
      members[group].push_back(id);
    }
    for (const std::vector<size_t>& ids : members)
      if (json one = sweep(rows, places, parameter, ids, metrics); !one.is_null())
        sweeps.push_back(std::move(one));
  }
  return sweeps;
}

}  // namespace gnomon
