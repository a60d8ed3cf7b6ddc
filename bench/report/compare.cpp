// Compares the rows of two runs of a suite: what became slower, faster, more or less exact.
#include "bench/report/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/report/report_rows.h"

namespace gnomon {
namespace {

using nlohmann::json;

// What was measured. A failed row has no measured reference: it is matched without.
std::string identity(const Row& row, bool with_reference) {
  json parts = {row.scene,  row.graph,      to_json(row.vars), {row.size.width, row.size.height},
                row.camera, row.device.name};
  if (with_reference) parts.push_back(row.reference ? json(row.reference->samples) : json());
  parts.push_back(row.light_scale);
  parts.push_back(row.sequence ? row.sequence->frames : 0);
  return parts.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string place_text(const Row& row) {
  return fmt::format("{} {}x{}{} {}", row.scene, row.size.width, row.size.height, light_scale_text(row),
                     label_of(row));
}

// Finds the row of an earlier run that measured the same.
class EarlierRows {
 public:
  explicit EarlierRows(const std::vector<Row>& rows) {
    for (const Row& row : rows) {
      exact_.emplace(identity(row, true), &row);
      bare_.emplace(identity(row, false), &row);
    }
  }
  const Row* match(const Row& row) const {
    if (const auto found = exact_.find(identity(row, true)); found != exact_.end()) return found->second;
    const auto found = bare_.find(identity(row, false));
    if (found == bare_.end() || (found->second->ok() && row.ok())) return nullptr;
    return found->second;
  }

 private:
  std::map<std::string, const Row*> exact_, bare_;
};

void compare_time(const Row& before, const Row& after, double tolerance, Comparison& comparison) {
  // The baseline is divided by itself: 1 in every round, of any run.
  if (!before.ratio || !after.ratio || (before.is_baseline && after.is_baseline)) return;
  const Summary &was = before.ratio->value, &is = after.ratio->value;
  const bool above = is.low > was.high, below = is.high < was.low;
  ++comparison.intervals;
  if (!above && !below) ++comparison.overlapping;
  const bool slower = above && is.median > was.median * (1 + tolerance);
  const bool faster = below && is.median < was.median / (1 + tolerance);
  if (slower || faster)
    comparison.changes.push_back(
        {Change::Kind::time, place_text(after), "ratio", was.median, is.median, slower});
}

void compare_errors(const Row& before, const Row& after, std::vector<Change>& changes) {
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

Comparison compare_results(const std::vector<Row>& before, const std::vector<Row>& after, double tolerance) {
  Comparison comparison;
  std::set<const Row*> met;
  const EarlierRows earlier(before);
  for (const Row& row : after) {
    const Row* const old = earlier.match(row);
    if (old == nullptr) continue;
    met.insert(old);
    const bool ran = old->ok(), runs = row.ok();
    if (ran != runs)
      comparison.changes.push_back({Change::Kind::failure, place_text(row), row.status, 0, 0, !runs});
    if (!ran || !runs) continue;
    ++comparison.compared;
    compare_time(*old, row, tolerance, comparison);
    compare_errors(*old, row, comparison.changes);
  }
  for (const Row& row : before)
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
