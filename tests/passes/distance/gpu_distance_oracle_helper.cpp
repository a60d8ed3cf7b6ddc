// Distance transforms on the CPU, in 64-bit integers.
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/passes/distance/gpu_distance_oracle.h"

namespace gnomon::distance_oracle {
namespace {

constexpr int64_t kFar = int64_t(1) << 30;  // rows: further than any in an image

int64_t floor_divide(int64_t a, int64_t b) { return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0); }

// Rows to the nearest site of the same column, or kFar.
std::vector<int64_t> column_distances(const Image& mask) {
  const size_t width = mask.width, height = mask.height;
  std::vector<int64_t> g(width * height, kFar);
  for (size_t y = 0; y < height; ++y)
    for (size_t x = 0; x < width; ++x) {
      const size_t i = y * width + x;
      if (mask.data[i] != 0)
        g[i] = 0;
      else if (y > 0 && g[i - width] < kFar)
        g[i] = g[i - width] + 1;
    }
  for (size_t y = height - 1; y-- > 0;)
    for (size_t x = 0; x < width; ++x) {
      const size_t i = y * width + x;
      if (g[i + width] < kFar) g[i] = std::min(g[i], g[i + width] + 1);
    }
  return g;
}

void transform_row(const int64_t* g, int64_t width, int64_t* result) {
  const auto f = [&](int64_t x, int64_t i) { return (x - i) * (x - i) + g[i] * g[i]; };
  std::vector<int64_t> s, t;  // columns, and where each begins to be nearest
  for (int64_t u = 0; u < width; ++u) {
    if (g[u] >= kFar) continue;
    while (!s.empty() && f(t.back(), s.back()) > f(t.back(), u)) s.pop_back(), t.pop_back();
    int64_t start = 0;
    if (!s.empty()) {
      const int64_t i = s.back();
      start = 1 + floor_divide(u * u - i * i + g[u] * g[u] - g[i] * g[i], 2 * (u - i));
    }
    if (start < width) s.push_back(u), t.push_back(start);
  }
  for (int64_t x = width - 1; x >= 0; --x) {
    result[x] = s.empty() ? kNone : f(x, s.back());
    if (!s.empty() && t.back() == x) s.pop_back(), t.pop_back();
  }
}

}  // namespace

std::vector<int64_t> squared_distances(const Image& mask) {
  const std::vector<int64_t> g = column_distances(mask);
  std::vector<int64_t> result(g.size());
  for (size_t y = 0; y < mask.height; ++y)
    transform_row(g.data() + y * mask.width, mask.width, result.data() + y * mask.width);
  return result;
}

std::vector<int64_t> squared_distances_by_brute_force(const Image& mask) {
  std::vector<std::pair<int64_t, int64_t>> sites;
  for (uint32_t y = 0; y < mask.height; ++y)
    for (uint32_t x = 0; x < mask.width; ++x)
      if (mask.at(x, y) != 0) sites.emplace_back(x, y);
  std::vector<int64_t> result;
  for (int64_t y = 0; y < mask.height; ++y)
    for (int64_t x = 0; x < mask.width; ++x) {
      int64_t least = kNone;
      for (const auto& [sx, sy] : sites) {
        const int64_t squared = (sx - x) * (sx - x) + (sy - y) * (sy - y);
        if (least == kNone || squared < least) least = squared;
      }
      result.push_back(least);
    }
  return result;
}

Image make_mask(uint32_t width, uint32_t height, const std::function<bool(uint32_t, uint32_t)>& is_site) {
  Image mask(width, height, {"Y"});
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) mask.at(x, y) = is_site(x, y) ? 1.0f : 0.0f;
  return mask;
}

Image random_mask(uint32_t width, uint32_t height, double density, uint32_t seed) {
  std::mt19937 generator(seed);
  const auto limit = uint32_t(density * 4294967295.0);
  return make_mask(width, height, [&](uint32_t, uint32_t) { return generator() < limit; });
}

std::vector<NamedMask> masks(uint32_t width, uint32_t height) {
  std::vector<NamedMask> all;
  const auto add = [&](std::string name, const std::function<bool(uint32_t, uint32_t)>& is_site) {
    all.push_back({std::move(name), make_mask(width, height, is_site)});
  };
  add("empty", [](uint32_t, uint32_t) { return false; });
  add("full", [](uint32_t, uint32_t) { return true; });
  add("first pixel", [](uint32_t x, uint32_t y) { return x == 0 && y == 0; });
  add("last pixel", [=](uint32_t x, uint32_t y) { return x + 1 == width && y + 1 == height; });
  add("inner pixel", [=](uint32_t x, uint32_t y) { return x == width / 3 && y == 2 * height / 3; });
  add("horizontal lines", [=](uint32_t, uint32_t y) { return y % 37 == height % 37; });
  add("vertical lines", [=](uint32_t x, uint32_t) { return x % 41 == width % 41; });
  add("checkerboard", [](uint32_t x, uint32_t y) { return (x + y) % 2 == 0; });
  add("coarse checkerboard", [](uint32_t x, uint32_t y) { return x % 16 == 0 && y % 16 == 0; });
  add("diagonal", [=](uint32_t x, uint32_t y) { return uint64_t(x) * height / width == y; });
  add("ring", [=](uint32_t x, uint32_t y) {
    const double r = std::hypot(x - width / 2.0, y - height / 2.0), wanted = 0.45 * std::min(width, height);
    return std::abs(r - wanted) < 0.7;
  });
  for (const double density : {0.5, 0.05, 0.002, 0.00005})
    all.push_back({"random " + std::to_string(density), random_mask(width, height, density, width + height)});
  return all;
}

}  // namespace gnomon::distance_oracle
