#include "bench/statistics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace gnomon {
namespace {

double median_of_sorted(const std::vector<double>& sorted) {
  const size_t n = sorted.size();
  if (n == 0) return 0;
  return n % 2 == 1 ? sorted[n / 2] : 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]);
}

// Coverage of [x(rank), x(n + 1 - rank)], rank from 1: 1 - 2 P(B(n, 1/2) < rank). Through logarithms, so that
// a large n does not underflow.
double median_coverage(size_t n, size_t rank) {
  double tail = 0;
  for (size_t k = 0; k < rank; ++k) {
    tail += std::exp(std::lgamma(double(n) + 1) - std::lgamma(double(k) + 1) -
                     std::lgamma(double(n - k) + 1) - double(n) * std::log(2.0));
  }
  return std::max(0.0, 1 - 2 * tail);
}

}  // namespace

double median(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  return median_of_sorted(samples);
}

Summary summarise(std::span<const double> samples) {
  Summary summary;
  summary.n = samples.size();
  if (samples.empty()) return summary;
  std::vector<double> sorted(samples.begin(), samples.end());
  if (!std::all_of(sorted.begin(), sorted.end(), [](double x) { return std::isfinite(x); }))
    throw std::invalid_argument("a timing is not finite");
  std::sort(sorted.begin(), sorted.end());
  summary.median = median_of_sorted(sorted);
  std::vector<double> deviations;
  deviations.reserve(sorted.size());
  for (const double x : sorted) deviations.push_back(std::abs(x - summary.median));
  summary.mad = median(std::move(deviations));
  size_t rank = 1;
  while (2 * (rank + 1) <= summary.n && median_coverage(summary.n, rank + 1) >= 0.95) ++rank;
  summary.low = sorted[rank - 1];
  summary.high = sorted[summary.n - rank];
  summary.coverage = median_coverage(summary.n, rank);
  return summary;
}

std::vector<double> pair_ratios(std::span<const double> values, std::span<const double> baseline) {
  std::vector<double> ratios;
  for (size_t i = 0; i < std::min(values.size(), baseline.size()); ++i)
    if (baseline[i] > 0) ratios.push_back(values[i] / baseline[i]);
  return ratios;
}

}  // namespace gnomon
