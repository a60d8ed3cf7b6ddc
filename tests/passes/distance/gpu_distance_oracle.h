// Exact squared distances to the nearest site, by two plain CPU algorithms, and masks to try transforms on.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/image/image.h"

namespace gnomon::distance_oracle {

constexpr int64_t kNone = -1;  // no site in the image

// Meijster, Roerdink and Hesselink 2000 in 64-bit integers; a pixel each, row 0 at the top.
std::vector<int64_t> squared_distances(const Image& mask);
// Every pixel against every site.
std::vector<int64_t> squared_distances_by_brute_force(const Image& mask);

// 1 where `is_site`.
Image make_mask(uint32_t width, uint32_t height, const std::function<bool(uint32_t x, uint32_t y)>& is_site);
Image random_mask(uint32_t width, uint32_t height, double density, uint32_t seed);

struct NamedMask {
  std::string name;
  Image image;
};
// Empty, full, one site in places that matter, random ones of several densities, lines, checkerboards,
// diagonals and rings.
std::vector<NamedMask> masks(uint32_t width, uint32_t height);

}  // namespace gnomon::distance_oracle
