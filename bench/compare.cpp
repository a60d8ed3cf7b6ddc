#include "bench/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/report_rows.h"

namespace gnomon {
namespace {

using nlohmann::json;

std::string identity(const json& row) {
  json parts = json::array();
  for (const char* name : {"scene", "graph", "vars", "size", "camera", "device", "reference"})
    parts.push_back(row.contains(name) && !row[name].is_null() ? row[name] : json(""));
  // A failed row has no measured reference: it is matched without.
  if (!is_ok(row)) parts.back() = "";
  parts.push_back(figure_at(row, "/sequence/frames").value_or(0));
  return parts.dump();
}

std::string place_text(const json& row) {
  const auto width = figure_at(row, "/size/0"), height = figure_at(row, "/size/1");
  return fmt::format("{} {:g}x{:g} {}", row.value("scene", "?"), width.value_or(0), height.value_or(0),
                     row_label(row));
}

// `other` matches `row`, where a failed row matches whatever its reference was.
const json* find_match(const std::vector<json>& rows, const json& row) {
  const std::string wanted = identity(row);
  json failed = row;
  failed["status"] = "error";
  const std::string failed_identity = identity(failed);
  const json* fallback = nullptr;
  for (const json& other : rows) {
    if (identity(other) == wanted) return &other;
    json bare = other;
    bare["status"] = "error";
    if ((!is_ok(other) || !is_ok(row)) && identity(bare) == failed_identity) fallback = &other;
  }
  return fallback;
}

void compare_time(const json& before, const json& after, double tolerance, std::vector<Change>& changes) {
  const auto old_median = figure_at(before, "/ratio/median"), new_median = figure_at(after, "/ratio/median");
  const auto old_low = figure_at(before, "/ratio/ci95/0"), old_high = figure_at(before, "/ratio/ci95/1");
  const auto new_low = figure_at(after, "/ratio/ci95/0"), new_high = figure_at(after, "/ratio/ci95/1");
  if (!old_median || !new_median || !old_low || !old_high || !new_low || !new_high) return;
  const bool slower = *new_low > *old_high && *new_median > *old_median * (1 + tolerance);
  const bool faster = *new_high < *old_low && *new_median < *old_median / (1 + tolerance);
  if (slower || faster)
    changes.push_back({Change::Kind::time, place_text(after), "ratio", *old_median, *new_median, slower});
}

void compare_errors(const json& before, const json& after, std::vector<Change>& changes) {
  for (const std::string& metric : error_metrics()) {
    const auto was = error_of(before, metric), is = error_of(after, metric);
    if (was && is && was->value != is->value)
      changes.push_back(
          {Change::Kind::error, place_text(after), metric, was->value, is->value, is->value > was->value});
  }
}

std::string line_of(const Change& change) {
  const char* const verdict = change.worse ? "worse" : "better";
  switch (change.kind) {
    case Change::Kind::time:
    case Change::Kind::error:
      return fmt::format("{:<7}{:<18}{:>12.6g}{:>12.6g}  {}\n", verdict, change.what, change.before,
                         change.after, change.where);
    case Change::Kind::failure:
      return fmt::format("{:<7}{}  {}\n", verdict, change.where, change.what);
    case Change::Kind::missing:
      break;
  }
  return fmt::format("{:<7}{}\n", "gone", change.where);
}

}  // namespace

bool Comparison::regressed() const {
  return std::any_of(changes.begin(), changes.end(), [](const Change& change) { return change.worse; });
}

Comparison compare_results(const std::vector<json>& before, const std::vector<json>& after,
                           double tolerance) {
  Comparison comparison;
  std::set<const json*> met;
  for (const json& row : after) {
    const json* const old = find_match(before, row);
    if (old == nullptr) continue;
    met.insert(old);
    const bool ran = is_ok(*old), runs = is_ok(row);
    if (ran != runs)
      comparison.changes.push_back(
          {Change::Kind::failure, place_text(row), row.value("status", "?"), 0, 0, !runs});
    if (!ran || !runs) continue;
    ++comparison.compared;
    compare_time(*old, row, tolerance, comparison.changes);
    compare_errors(*old, row, comparison.changes);
  }
  for (const json& row : before)
    if (met.count(&row) == 0)
      comparison.changes.push_back({Change::Kind::missing, place_text(row), "", 0, 0, false});
  return comparison;
}

std::string to_table(const Comparison& comparison) {
  std::string text;
  if (!comparison.changes.empty())
    text = fmt::format("{:<7}{:<18}{:>12}{:>12}  {}\n", "", "figure", "before", "now", "row");
  for (const Change& change : comparison.changes) text += line_of(change);
  const auto worse = std::count_if(comparison.changes.begin(), comparison.changes.end(),
                                   [](const Change& change) { return change.worse; });
  return text + fmt::format("{} rows compared, {} changes, {} for the worse\n", comparison.compared,
                            comparison.changes.size(), worse);
}

}  // namespace gnomon
