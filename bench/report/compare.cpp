// Compares the rows of two runs of a suite: what became slower, faster, more or less exact.
#include "bench/report/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "bench/report/report_rows.h"

namespace gnomon {
namespace {

using nlohmann::json;

// What was measured. A failed row has no measured reference: it is matched without.
std::string identity(const json& row, bool with_reference) {
  json parts = json::array();
  for (const char* name : {"scene", "graph", "vars", "size", "camera", "device"})
    parts.push_back(row.contains(name) && !row[name].is_null() ? row[name] : json(""));
  if (with_reference)
    parts.push_back(row.contains("reference") && !row["reference"].is_null() ? row["reference"] : json(""));
  parts.push_back(figure_at(row, "/light_scale").value_or(1));
  parts.push_back(figure_at(row, "/sequence/frames").value_or(0));
  return parts.dump();
}

std::string place_text(const json& row) {
  const auto width = figure_at(row, "/size/0"), height = figure_at(row, "/size/1");
  return fmt::format("{} {:g}x{:g}{} {}", row.value("scene", "?"), width.value_or(0), height.value_or(0),
                     light_scale_text(row), row_label(row));
}

// Finds the row of an earlier run that measured the same.
class EarlierRows {
 public:
  explicit EarlierRows(const std::vector<json>& rows) {
    for (const json& row : rows) {
      exact_.emplace(identity(row, true), &row);
      bare_.emplace(identity(row, false), &row);
    }
  }
  const json* match(const json& row) const {
    if (const auto found = exact_.find(identity(row, true)); found != exact_.end()) return found->second;
    const auto found = bare_.find(identity(row, false));
    if (found == bare_.end() || (is_ok(*found->second) && is_ok(row))) return nullptr;
    return found->second;
  }

 private:
  std::map<std::string, const json*> exact_, bare_;
};

struct Ratios {
  double median = 0, low = 0, high = 0;
};
std::optional<Ratios> ratios_of(const json& row) {
  const auto median = figure_at(row, "/ratio/median");
  const auto low = figure_at(row, "/ratio/ci95/0"), high = figure_at(row, "/ratio/ci95/1");
  if (!median || !low || !high) return std::nullopt;
  return Ratios{*median, *low, *high};
}

// Divided by itself: 1 in every round, of any run.
bool is_baseline(const Ratios& ratios) { return ratios.low == 1 && ratios.high == 1; }

void compare_time(const json& before, const json& after, double tolerance, Comparison& comparison) {
  const auto was = ratios_of(before), is = ratios_of(after);
  if (!was || !is || (is_baseline(*was) && is_baseline(*is))) return;
  const bool above = is->low > was->high, below = is->high < was->low;
  ++comparison.intervals;
  if (!above && !below) ++comparison.overlapping;
  const bool slower = above && is->median > was->median * (1 + tolerance);
  const bool faster = below && is->median < was->median / (1 + tolerance);
  if (slower || faster)
    comparison.changes.push_back(
        {Change::Kind::time, place_text(after), "ratio", was->median, is->median, slower});
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

double Comparison::overlap() const {
  return intervals == 0 ? 1 : static_cast<double>(overlapping) / static_cast<double>(intervals);
}

Comparison compare_results(const std::vector<json>& before, const std::vector<json>& after,
                           double tolerance) {
  Comparison comparison;
  std::set<const json*> met;
  const EarlierRows earlier(before);
  for (const json& row : after) {
    const json* const old = earlier.match(row);
    if (old == nullptr) continue;
    met.insert(old);
    const bool ran = is_ok(*old), runs = is_ok(row);
    if (ran != runs)
      comparison.changes.push_back(
          {Change::Kind::failure, place_text(row), row.value("status", "?"), 0, 0, !runs});
    if (!ran || !runs) continue;
    ++comparison.compared;
    compare_time(*old, row, tolerance, comparison);
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
  if (comparison.intervals > 0)
    text += fmt::format("{} of {} intervals of the ratio to the baseline overlap ({:.1f} %)\n",
                        comparison.overlapping, comparison.intervals, 100 * comparison.overlap());
  return text + fmt::format("{} rows compared, {} changes, {} for the worse\n", comparison.compared,
                            comparison.changes.size(), worse);
}

}  // namespace gnomon
