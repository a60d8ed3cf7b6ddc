// Medians, deviations and intervals against values worked out by hand.
#include "bench/run/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace gnomon {
namespace {

TEST(Statistics, NothingGivesZeros) {
  const Summary summary = summarise({});
  EXPECT_EQ(summary.n, 0u);
  EXPECT_EQ(summary.median, 0);
  EXPECT_EQ(summary.coverage, 0);
}

TEST(Statistics, OneSampleIsItsOwnInterval) {
  const double samples[] = {3.5};
  const Summary summary = summarise(samples);
  EXPECT_EQ(summary.n, 1u);
  EXPECT_EQ(summary.median, 3.5);
  EXPECT_EQ(summary.mad, 0);
  EXPECT_EQ(summary.low, 3.5);
  EXPECT_EQ(summary.high, 3.5);
  EXPECT_DOUBLE_EQ(summary.coverage, 0.0);  // the true median is below or above, with probability one
}

TEST(Statistics, MedianOfOddAndEvenCounts) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(median({}), 0);
}

TEST(Statistics, MadIsTheMedianDistanceAndIgnoresOneOutlier) {
  const double samples[] = {1, 2, 3, 4, 1000};
  const Summary summary = summarise(samples);
  EXPECT_EQ(summary.median, 3);
  EXPECT_EQ(summary.mad, 1);  // distances 2 1 0 1 997
}

// P(min <= median <= max) = 1 - 2 / 2^n: 0.9375 for n = 5, 0.96875 for n = 6.
TEST(Statistics, FewSamplesGiveTheirRangeWithItsCoverage) {
  const double five[] = {5, 1, 4, 2, 3};
  const Summary summary = summarise(five);
  EXPECT_EQ(summary.low, 1);
  EXPECT_EQ(summary.high, 5);
  EXPECT_NEAR(summary.coverage, 0.9375, 1e-12);
  const double six[] = {5, 1, 4, 2, 3, 6};
  EXPECT_NEAR(summarise(six).coverage, 0.96875, 1e-12);
  EXPECT_EQ(summarise(six).low, 1);
}

// The classical table of distribution-free intervals: n = 9 -> ranks 2 and 8 (96.1 %), n = 11 -> 2 and 10
// (98.8 %), n = 20 -> 6 and 15 (95.9 %).
TEST(Statistics, IntervalRanksFollowTheBinomialTable) {
  const auto ranks = [](size_t n) {
    std::vector<double> samples;
    for (size_t i = 1; i <= n; ++i) samples.push_back(double(i));
    return summarise(samples);
  };
  EXPECT_EQ(ranks(9).low, 2);
  EXPECT_EQ(ranks(9).high, 8);
  EXPECT_NEAR(ranks(9).coverage, 0.9609375, 1e-9);
  EXPECT_EQ(ranks(11).low, 2);
  EXPECT_EQ(ranks(11).high, 10);
  EXPECT_EQ(ranks(20).low, 6);
  EXPECT_EQ(ranks(20).high, 15);
  EXPECT_NEAR(ranks(20).coverage, 0.9586105, 1e-6);
}

TEST(Statistics, ManySamplesDoNotUnderflow) {
  std::vector<double> samples;
  for (int i = 0; i < 5001; ++i) samples.push_back(i);
  const Summary summary = summarise(samples);
  EXPECT_EQ(summary.median, 2500);
  // Normal approximation: 2500 +- 1.96 sqrt(5001) / 2.
  EXPECT_NEAR(summary.low, 2500 - 69.3, 2);
  EXPECT_NEAR(summary.high, 2500 + 69.3, 2);
  EXPECT_GE(summary.coverage, 0.95);
  EXPECT_LT(summary.coverage, 0.9535);  // one rank less is 0.0033 of coverage less
}

// The stated coverage holds: of 4000 intervals from a skewed distribution (median ln 2) at least 95 % hold
// it.
TEST(Statistics, IntervalCoversTheTrueMedian) {
  std::mt19937 generator(7);
  const auto exponential = [&] { return -std::log(1 - (double(generator()) + 0.5) / 4294967296.0); };
  int hits = 0;
  constexpr int trials = 4000;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> samples(15);
    for (double& sample : samples) sample = exponential();
    const Summary summary = summarise(samples);
    hits += summary.low <= std::log(2.0) && std::log(2.0) <= summary.high ? 1 : 0;
  }
  // Three standard errors, sqrt(0.05 * 0.95 / 4000) = 0.0034.
  EXPECT_GT(double(hits) / trials, 0.95 - 0.0103);
}

TEST(Statistics, NonFiniteTimingIsRefused) {
  const double samples[] = {1, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_THROW(summarise(samples), std::invalid_argument);
}

TEST(Statistics, RatiosArePairedByRound) {
  const double values[] = {2, 6, 4}, baseline[] = {1, 2, 4};
  const std::vector<double> ratios = pair_ratios(values, baseline);
  ASSERT_EQ(ratios.size(), 3u);
  EXPECT_EQ(ratios[0], 2);
  EXPECT_EQ(ratios[1], 3);
  EXPECT_EQ(ratios[2], 1);
}

// A slow spell that hits both sides of a round leaves the ratio alone, though it moves both medians.
TEST(Statistics, SlowSpellCancelsInPairs) {
  const double values[] = {2, 2, 20, 20, 20}, baseline[] = {1, 1, 10, 10, 10};
  EXPECT_EQ(median(pair_ratios(values, baseline)), 2);
}

TEST(Statistics, PairsWithoutABaselineAreLeftOut) {
  const double values[] = {2, 6, 4}, baseline[] = {0, 2};
  const std::vector<double> ratios = pair_ratios(values, baseline);
  ASSERT_EQ(ratios.size(), 1u);
  EXPECT_EQ(ratios[0], 3);
}

}  // namespace
}  // namespace gnomon
