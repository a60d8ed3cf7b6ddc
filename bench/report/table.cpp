// Lays out rows of results.jsonl as a table of text.
#include "bench/report/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "bench/report/report_rows.h"
#include "engine/base/printable.h"

namespace gnomon {
namespace {

using Figure = std::optional<double>;

struct Column {
  const char* title = "";
  Figure (*figure)(const Row&) = nullptr;
  double scale = 1;
  int digits = 0;
  bool where_any = false;  // only in tables where some row has a figure
};
constexpr Column kColumns[] = {
    {"misclass. %", [](const Row& row) { return figure_of(row.error, "misclassified"); }, 100, 3},
    {"wrongly lit %", [](const Row& row) { return figure_of(row.error, "wrongly_lit"); }, 100, 3},
    {"wrongly shad. %", [](const Row& row) { return figure_of(row.error, "wrongly_shadowed"); }, 100, 3},
    {"acne %", [](const Row& row) { return figure_of(row.error, "acne"); }, 100, 4},
    {"RMSE", [](const Row& row) { return figure_of(row.error, "rmse"); }, 1, 4},
    {"mean RMSE",
     [](const Row& row) {
       return row.sequence && row.sequence->rmse ? Figure(row.sequence->rmse->mean) : std::nullopt;
     },
     1, 4, true},
    {"flicker", [](const Row& row) { return row.flicker; }, 1, 5, true},
    {"ms", frame_ms_of, 1, 2},
    {"ratio", [](const Row& row) { return row.ratio ? Figure(row.ratio->value.median) : std::nullopt; }, 1,
     3},
};
constexpr size_t kColumnCount = std::size(kColumns);
using Figures = std::vector<Figure>;

struct Line {
  std::string technique, failure;
  Figures figures;
};
struct Group {
  std::string title;
  std::vector<Line> lines;
};

Figures figures_of(const Row& row) {
  Figures figures;
  for (const Column& column : kColumns) {
    const Figure figure = column.figure(row);
    figures.push_back(figure ? Figure(column.scale * *figure) : std::nullopt);
  }
  return figures;
}

// Variables of each graph that are not the same in all of its rows.
std::map<std::string, std::set<std::string>> varying(const std::vector<Row>& rows) {
  std::map<std::string, std::map<std::string, std::set<std::string>>> seen;
  for (const Row& row : rows)
    for (const auto& [name, value] : row.vars) seen[row.graph][name].insert(to_string(value));
  std::map<std::string, std::set<std::string>> names;
  for (const auto& [graph, vars] : seen)
    for (const auto& [name, values] : vars)
      if (values.size() > 1) names[graph].insert(name);
  return names;
}

std::string technique_of(const Row& row, const std::map<std::string, std::set<std::string>>& shown) {
  std::string text = printable(row.graph);
  const auto names = shown.find(row.graph);
  if (names == shown.end()) return text;
  for (const std::string& name : names->second)
    if (const auto value = row.vars.find(name); value != row.vars.end())
      text += fmt::format(" {}={}", printable(name), printable(to_string(value->second)));
  return text;
}

Line line_of(const Row& row, const std::string& technique) {
  return {technique, row.ok() ? "" : row.status.substr(0, row.status.find('\n')), figures_of(row)};
}

// In the order in which scenes and sizes first appear.
std::vector<Group> group(const std::vector<Row>& rows) {
  const auto shown = varying(rows);
  std::vector<Group> groups;
  for (const Row& row : rows) {
    const std::string title = fmt::format("{}, {}x{}{}", printable(row.scene), row.size.width,
                                          row.size.height, light_scale_text(row));
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
      auto [entry, fresh] = sums.try_emplace(line.technique, kColumnCount);
      if (fresh) order.push_back(line.technique);
      for (size_t i = 0; i < kColumnCount && line.failure.empty(); ++i) {
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
  for (size_t i = 0; i < kColumnCount; ++i) {
    const auto has_figure = [i](const Line& line) { return line.figures[i].has_value(); };
    if (!kColumns[i].where_any || std::any_of(one.lines.begin(), one.lines.end(), has_figure))
      shown.push_back(i);
  }
  return shown;
}

std::string to_text(const Group& one) {
  const size_t width = technique_width(one);
  const std::vector<size_t> shown = shown_columns(one);
  std::string text = one.title + "\n" + fmt::format("  {:<{}}", "technique", width);
  for (const size_t i : shown) text += fmt::format("  {:>{}}", kColumns[i].title, column_width(kColumns[i]));
  text += "\n";
  for (const Line& line : one.lines) {
    text += fmt::format("  {:<{}}", line.technique, width);
    if (!line.failure.empty()) {
      text += "  " + line.failure + "\n";
      continue;
    }
    for (const size_t i : shown)
      text += fmt::format("  {:>{}}", cell(line.figures[i], kColumns[i].digits), column_width(kColumns[i]));
    text += "\n";
  }
  return text;
}

}  // namespace

std::string to_table(const std::vector<Row>& rows) {
  const std::vector<Group> groups = group(rows);
  std::string text;
  for (const Group& one : groups) text += to_text(one) + "\n";
  if (groups.size() > 1) text += to_text(means(groups)) + "\n";
  return text;
}

}  // namespace gnomon
