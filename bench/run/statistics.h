// Robust statistics of repeated timings.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace gnomon {

// Of n samples; all zero when n = 0. The unit is the samples' own.
struct Summary {
  size_t n = 0;
  double median = 0;    // mean of the middle two when n is even
  double mad = 0;       // median absolute deviation from the median, unscaled
  double low = 0;       // interval of the median that needs no assumption about the distribution: two order
  double high = 0;      // statistics x(l), x(n+1-l) with the largest l whose coverage is at least 95 %
  double coverage = 0;  // probability that [low, high] holds the true median: 1 - 2 P(B(n, 1/2) < l). Below
                        // 0.95 only when n < 6, where [min, max] is given
};

// Non-finite samples are a programming error and throw std::invalid_argument.
Summary summarise(std::span<const double> samples);
double median(std::vector<double> samples);

// values[i] / baseline[i], for pairs measured in the same round. Rounds that either side lacks (the shorter
// length) and pairs with a baseline that is not positive are left out.
std::vector<double> pair_ratios(std::span<const double> values, std::span<const double> baseline);

}  // namespace gnomon
