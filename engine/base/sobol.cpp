// The 2D Sobol sequence and its Owen scrambling.
#include "engine/base/sobol.h"

namespace gnomon {
namespace {

uint32_t reverse_bits(uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
}

// Each bit is flipped by a hash of the bits below it (Laine and Karras 2011, constants of Burley 2020).
uint32_t laine_karras_permutation(uint32_t x, uint32_t seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return x;
}

// Second dimension: primitive polynomial x + 1, direction numbers v_k = v_{k-1} ^ (v_{k-1} >> 1).
uint32_t second_dimension(uint32_t index) {
  uint32_t result = 0;
  for (uint32_t v = 1u << 31; index != 0; index >>= 1, v ^= v >> 1)
    if (index & 1) result ^= v;
  return result;
}

// Bits reversed, as the scrambling wants them. The first dimension is the reversed index, so that its
// reversal is the index itself.
glm::uvec2 reversed_point(uint32_t index) { return {index, reverse_bits(second_dimension(index))}; }

double to_unit(uint32_t bits) { return bits * 0x1p-32; }

}  // namespace

SobolPoints::SobolPoints(uint32_t count) {
  points_.reserve(count);
  for (uint32_t i = 0; i < count; ++i) points_.push_back(reversed_point(i));
}

glm::dvec2 SobolPoints::scrambled(uint32_t i, uint32_t seed) const {
  const glm::uvec2 point = i < points_.size() ? points_[i] : reversed_point(i);
  const uint32_t x = laine_karras_permutation(point.x, hash_combine(seed, 0));
  const uint32_t y = laine_karras_permutation(point.y, hash_combine(seed, 1));
  return {to_unit(reverse_bits(x)), to_unit(reverse_bits(y))};
}

uint32_t hash_combine(uint32_t seed, uint32_t value) {
  uint32_t h = seed ^ (value + 0x9e3779b9u + (seed << 6) + (seed >> 2));
  h ^= h >> 16, h *= 0x7feb352du;  // lowbias32, Wellons
  h ^= h >> 15, h *= 0x846ca68bu;
  h ^= h >> 16;
  return h;
}

}  // namespace gnomon
