// The oracle against brute force.
#include "tests/passes/distance/gpu_distance_oracle.h"

#include <gtest/gtest.h>

namespace gnomon::distance_oracle {
namespace {

TEST(DistanceOracle, AgreesWithBruteForce) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 40u}, {37u, 1u}, {31u, 33u}, {64u, 48u}})
    for (const NamedMask& mask : masks(width, height))
      EXPECT_EQ(squared_distances(mask.image), squared_distances_by_brute_force(mask.image))
          << mask.name << ' ' << width << 'x' << height;
}

TEST(DistanceOracle, IsExactFarBeyondFloats) {
  const Image mask = make_mask(9001, 1, [](uint32_t x, uint32_t) { return x == 0; });
  EXPECT_EQ(squared_distances(mask).back(), 81000000);
}

}  // namespace
}  // namespace gnomon::distance_oracle
