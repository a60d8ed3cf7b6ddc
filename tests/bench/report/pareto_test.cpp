// Which measurements no other beats, on lists worked out by hand.
#include "bench/report/pareto.h"

#include <gtest/gtest.h>

#include <limits>

namespace gnomon {
namespace {

using Indices = std::vector<size_t>;

TEST(Pareto, KeepsWhatNothingBeatsByTime) {
  const std::vector<TimeAndError> points = {{4, 1}, {1, 4}, {2, 2}, {3, 3}, {2, 5}};
  EXPECT_EQ(pareto_front(points), (Indices{1, 2, 0}));
}

TEST(Pareto, SlowerWithEqualErrorIsDominatedAndEqualsStay) {
  const std::vector<TimeAndError> points = {{2, 1}, {1, 1}, {1, 1}, {1, 2}};
  EXPECT_EQ(pareto_front(points), (Indices{1, 2}));
}

TEST(Pareto, ZeroErrorCountsAndWhatIsNotFiniteDoesNot) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<TimeAndError> points = {{1, nan}, {nan, 0}, {5, 0}, {3, 1}};
  EXPECT_EQ(pareto_front(points), (Indices{3, 2}));
  EXPECT_TRUE(pareto_front({}).empty());
}

}  // namespace
}  // namespace gnomon
