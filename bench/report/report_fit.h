// How time and error grow with a parameter.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace gnomon {

// y = factor * x^exponent.
struct PowerLaw {
  double factor = 0, exponent = 0;
  double r2 = 0;  // coefficient of determination of ln y; 1 when all y are equal or n = 2
  size_t n = 0;   // points that were used
};

// Least squares of ln y = ln factor + exponent * ln x, each point with the same weight. Points that are not
// positive and finite have no logarithm and are left out; without two different x there is no fit.
std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y);

}  // namespace gnomon
