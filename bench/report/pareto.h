// Which measurements are worth having: less error for the time, or less time for the error.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace gnomon {

struct TimeAndError {
  double ms = 0, error = 0;
};

// Indices of the candidates that no other dominates (takes at most the time, has at most the error, and is
// better in one of the two), by increasing time. Equal candidates are all kept; one with a figure that is not
// finite is never on the front.
std::vector<size_t> pareto_front(std::span<const TimeAndError> candidates);

}  // namespace gnomon
