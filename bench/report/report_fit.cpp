// Fits how time and error grow with a parameter, as powers of it.
#include "bench/report/report_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gnomon {

std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y) {
  std::vector<double> u, v;
  for (size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!(x[i] > 0) || !(y[i] > 0) || !std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    u.push_back(std::log(x[i]));
    v.push_back(std::log(y[i]));
  }
  if (u.empty()) return std::nullopt;
  const auto n = static_cast<double>(u.size());
  double mean_u = 0, mean_v = 0, uu = 0, uv = 0, vv = 0;
  for (size_t i = 0; i < u.size(); ++i) mean_u += u[i] / n, mean_v += v[i] / n;
  for (size_t i = 0; i < u.size(); ++i) {
    uu += (u[i] - mean_u) * (u[i] - mean_u);
    uv += (u[i] - mean_u) * (v[i] - mean_v);
    vv += (v[i] - mean_v) * (v[i] - mean_v);
  }
  constexpr double same = 1e-12;  // of logarithms: rounding of equal x
  if (uu <= same) return std::nullopt;
  PowerLaw law;
  law.exponent = uv / uu;
  law.factor = std::exp(mean_v - law.exponent * mean_u);
  law.r2 = vv <= same ? 1.0 : std::min(1.0, uv * uv / (uu * vv));
  law.n = u.size();
  return law;
}

}  // namespace gnomon
