// Lays out rows of results.jsonl as a table of text.
#include "bench/report/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "bench/report/report_rows.h"

namespace gnomon {
namespace {

using nlohmann::json;

struct Column {
  const char* title = "";
  const char* pointer = "";  // into a row
  double scale = 1;
  int digits = 0;
  bool where_any = false;  // only in tables where some row has a figure
};
constexpr Column columns[] = {
    {"misclass. %", "/error/misclassified", 100, 3},
    {"wrongly lit %", "/error/wrongly_lit", 100, 3},
    {"wrongly shad. %", "/error/wrongly_shadowed", 100, 3},
    {"acne %", "/error/acne", 100, 4},
    {"RMSE", "/error/rmse", 1, 4},
    {"mean RMSE", "/sequence/rmse/mean", 1, 4, true},
    {"flicker", "/flicker", 1, 5, true},
    {"ms", "/frame_ms/median", 1, 2},
    {"ratio", "/ratio/median", 1, 3},
};
constexpr size_t column_count = std::size(columns);
using Figures = std::vector<std::optional<double>>;

struct Line {
  std::string technique, failure;
  Figures figures;
};
struct Group {
  std::string title;
  std::vector<Line> lines;
};

std::optional<double> figure(const json& row, const Column& column) {
  const json::json_pointer pointer(column.pointer);
  if (!row.contains(pointer) || !row[pointer].is_number()) return std::nullopt;
  return column.scale * row[pointer].get<double>();
}

Figures figures_of(const json& row) {
  Figures figures;
  for (const Column& column : columns) figures.push_back(figure(row, column));
  return figures;
}

std::string text_of(const json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

// Variables of each graph that are not the same in all of its rows.
std::map<std::string, std::set<std::string>> varying(const std::vector<json>& rows) {
  std::map<std::string, std::map<std::string, std::set<std::string>>> seen;
  for (const json& row : rows)
    if (row.contains("vars"))
      for (const auto& [name, value] : row["vars"].items())
        seen[row.value("graph", "")][name].insert(text_of(value));
  std::map<std::string, std::set<std::string>> names;
  for (const auto& [graph, vars] : seen)
    for (const auto& [name, values] : vars)
      if (values.size() > 1) names[graph].insert(name);
  return names;
}

std::string technique_of(const json& row, const std::map<std::string, std::set<std::string>>& shown) {
  std::string text = row.value("graph", "?");
  const auto names = shown.find(text);
  if (names == shown.end() || !row.contains("vars")) return text;
  for (const std::string& name : names->second)
    if (row["vars"].contains(name)) text += fmt::format(" {}={}", name, text_of(row["vars"][name]));
  return text;
}

std::string size_of(const json& row) {
  const json size = row.value("size", json::array());
  return size.size() == 2 ? fmt::format("{}x{}", text_of(size[0]), text_of(size[1])) : std::string("?");
}

Line line_of(const json& row, const std::string& technique) {
  const std::string status = row.value("status", "?");
  return {technique, status == "ok" ? "" : status.substr(0, status.find('\n')), figures_of(row)};
}

// In the order in which scenes and sizes first appear.
std::vector<Group> group(const std::vector<json>& rows) {
  const auto shown = varying(rows);
  std::vector<Group> groups;
  for (const json& row : rows) {
    const std::string title = row.value("scene", "?") + ", " + size_of(row) + light_scale_text(row);
    auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.title == title; });
    if (found == groups.end()) found = groups.insert(groups.end(), Group{title, {}});
    found->lines.push_back(line_of(row, technique_of(row, shown)));
  }
  return groups;
}

// Mean of each figure over the scenes that have it, per technique.
Group means(const std::vector<Group>& groups) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<std::pair<double, size_t>>> sums;
  for (const Group& one : groups) {
    for (const Line& line : one.lines) {
      auto [entry, fresh] = sums.try_emplace(line.technique, column_count);
      if (fresh) order.push_back(line.technique);
      for (size_t i = 0; i < column_count && line.failure.empty(); ++i) {
        if (!line.figures[i]) continue;
        entry->second[i].first += *line.figures[i];
        ++entry->second[i].second;
      }
    }
  }
  Group result{fmt::format("mean of {} scenes and sizes", groups.size()), {}};
  for (const std::string& technique : order) {
    Line line{technique, "", {}};
    for (const auto& [sum, count] : sums[technique])
      line.figures.push_back(count > 0 ? std::optional(sum / double(count)) : std::nullopt);
    result.lines.push_back(std::move(line));
  }
  return result;
}

std::string cell(const std::optional<double>& value, int digits) {
  return value && std::isfinite(*value) ? fmt::format("{:.{}f}", *value, digits) : "-";
}

size_t column_width(const Column& column) { return std::max<size_t>(std::string(column.title).size(), 8); }

size_t technique_width(const Group& one) {
  size_t width = std::string("technique").size();
  for (const Line& line : one.lines) width = std::max(width, line.technique.size());
  return width;
}

// Indices of the columns that a table has.
std::vector<size_t> shown_columns(const Group& one) {
  std::vector<size_t> shown;
  for (size_t i = 0; i < column_count; ++i) {
    const auto has_figure = [i](const Line& line) { return line.figures[i].has_value(); };
    if (!columns[i].where_any || std::any_of(one.lines.begin(), one.lines.end(), has_figure))
      shown.push_back(i);
  }
  return shown;
}

std::string to_text(const Group& one) {
  const size_t width = technique_width(one);
  const std::vector<size_t> shown = shown_columns(one);
  std::string text = one.title + "\n" + fmt::format("  {:<{}}", "technique", width);
  for (const size_t i : shown) text += fmt::format("  {:>{}}", columns[i].title, column_width(columns[i]));
  text += "\n";
  for (const Line& line : one.lines) {
    text += fmt::format("  {:<{}}", line.technique, width);
    if (!line.failure.empty()) {
      text += "  " + line.failure + "\n";
      continue;
    }
    for (const size_t i : shown)
      text += fmt::format("  {:>{}}", cell(line.figures[i], columns[i].digits), column_width(columns[i]));
    text += "\n";
  }
  return text;
}

}  // namespace

std::string to_table(const std::vector<json>& rows) {
  const std::vector<Group> groups = group(rows);
  std::string text;
  for (const Group& one : groups) text += to_text(one) + "\n";
  if (groups.size() > 1) text += to_text(means(groups)) + "\n";
  return text;
}

}  // namespace gnomon
