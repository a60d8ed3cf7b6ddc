// Median, deviation and confidence interval of repeated timings.
#include "bench/run/statistics.h"

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

// P(B(n, 1/2) = k), through logarithms, so that a large n does not underflow.
double half_binomial(size_t n, size_t k) {
  return std::exp(std::lgamma(double(n) + 1) - std::lgamma(double(k) + 1) - std::lgamma(double(n - k) + 1) -
                  double(n) * std::log(2.0));
}

// The rank l, from 1, and coverage of the interval [x(l), x(n + 1 - l)].
struct Interval {
  size_t rank = 1;
  double coverage = 0;
};
Interval median_interval(size_t n) {
  double tail = half_binomial(n, 0);
  Interval best{1, std::max(0.0, 1 - 2 * tail)};
  for (size_t rank = 2; 2 * rank <= n; ++rank) {
    tail += half_binomial(n, rank - 1);
    if (1 - 2 * tail < 0.95) break;
    best = {rank, 1 - 2 * tail};
  }
  return best;
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
  const Interval interval = median_interval(summary.n);
  summary.low = sorted[interval.rank - 1];
  summary.high = sorted[summary.n - interval.rank];
  summary.coverage = interval.coverage;
  return summary;
}

std::vector<double> pair_ratios(std::span<const double> values, std::span<const double> baseline) {
  std::vector<double> ratios;
  for (size_t i = 0; i < std::min(values.size(), baseline.size()); ++i)
    if (baseline[i] > 0) ratios.push_back(values[i] / baseline[i]);
  return ratios;
}

}  // namespace gnomon
