// Finds the measurements that no other one beats in time and error.
#include "bench/report/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace gnomon {

std::vector<size_t> pareto_front(std::span<const TimeAndError> candidates) {
  std::vector<size_t> order;
  for (size_t i = 0; i < candidates.size(); ++i)
    if (std::isfinite(candidates[i].ms) && std::isfinite(candidates[i].error)) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::tie(candidates[a].ms, candidates[a].error, a) <
           std::tie(candidates[b].ms, candidates[b].error, b);
  });
  std::vector<size_t> front;
  TimeAndError last{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const size_t i : order) {
    const TimeAndError& candidate = candidates[i];
    const bool equal = candidate.ms == last.ms && candidate.error == last.error;
    if (!equal && !(candidate.error < last.error)) continue;
    front.push_back(i);
    last = candidate;
  }
  return front;
}

}  // namespace gnomon
