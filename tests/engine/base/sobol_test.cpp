// Owen-scrambled Sobol points: stratification, the one property that everything else rests on.
#include "engine/base/sobol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace gnomon {
namespace {

// 2^m points of a (0, m, 2)-net in base 2: every dyadic box of area 2^-m, whatever its shape, holds exactly
// one.
TEST(Sobol, EveryDyadicBoxHoldsOnePoint) {
  for (const uint32_t seed : {0u, 1u, 12345u, 0xffffffffu})
    for (const int m : {4, 6, 10}) {
      const SobolPoints points(1u << m);
      for (int k = 0; k <= m; ++k) {  // 2^k columns, 2^(m - k) rows
        std::set<std::pair<int, int>> boxes;
        for (uint32_t i = 0; i < points.size(); ++i) {
          const glm::dvec2 p = points.scrambled(i, seed);
          ASSERT_GE(std::min(p.x, p.y), 0);
          ASSERT_LT(std::max(p.x, p.y), 1);
          boxes.emplace(int(p.x * (1 << k)), int(p.y * (1 << (m - k))));
        }
        EXPECT_EQ(boxes.size(), points.size()) << "seed " << seed << ", " << (1 << k) << " columns";
      }
    }
}

// Over seeds, every point is uniform: mean 1/2 within 4 standard errors, 4 / sqrt(12 n).
TEST(Sobol, SeedsDecorrelate) {
  const SobolPoints points(4);
  constexpr int n = 20000;
  glm::dvec2 sum(0);
  double product = 0;
  for (uint32_t seed = 0; seed < n; ++seed) {
    const glm::dvec2 p = points.scrambled(3, hash_combine(7, seed));
    sum += p;
    product += (p.x - 0.5) * (p.y - 0.5);
  }
  EXPECT_NEAR(sum.x / n, 0.5, 4 / std::sqrt(12.0 * n));
  EXPECT_NEAR(sum.y / n, 0.5, 4 / std::sqrt(12.0 * n));
  EXPECT_NEAR(product / n, 0, 4 / (12 * std::sqrt(double(n))));
}

}  // namespace
}  // namespace gnomon
