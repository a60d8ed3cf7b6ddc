// Low-discrepancy samples of the unit square.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace gnomon {

// The 2D Sobol sequence (Joe and Kuo's first two dimensions), as 32-bit fixed point.
class SobolPoints {
 public:
  // The first `count` points come from a table; later ones take longer.
  explicit SobolPoints(uint32_t count);
  uint32_t size() const { return static_cast<uint32_t>(points_.size()); }
  // Any point `i`, in [0, 1)^2, Owen-scrambled: every seed gives another randomisation that stays a
  // low-discrepancy set. Hash-based (Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020).
  glm::dvec2 scrambled(uint32_t i, uint32_t seed) const;

 private:
  std::vector<glm::uvec2> points_;  // bits reversed, as the scrambling wants them
};

// Mixes two numbers into one that looks random; for seeds.
uint32_t hash_combine(uint32_t seed, uint32_t value);

}  // namespace gnomon
