// Picks the technique and setting that a budget of time or error asks for.
#include "bench/report/pick.h"

#include <utility>

#include "bench/report/report_rows.h"

namespace gnomon {

std::optional<size_t> pick_row(const std::vector<Row>& rows, const PickRule& rule) {
  std::optional<size_t> best;
  std::pair<double, double> best_score;
  for (size_t i = 0; i < rows.size(); ++i) {
    const auto ms = frame_ms_of(rows[i]);
    const auto error = error_of(rows[i], rule.metric);
    if (!rows[i].ok() || !ms || !error) continue;
    if (rule.max_ms && rows[i].frame_ms->high > *rule.max_ms) continue;
    if (rule.max_error && error->value > *rule.max_error) continue;
    const auto score = rule.max_ms ? std::pair(error->value, *ms) : std::pair(*ms, error->value);
    if (best && !(score < best_score)) continue;
    best = i;
    best_score = score;
  }
  return best;
}

}  // namespace gnomon
