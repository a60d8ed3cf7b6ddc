// Revectorizes visibility maps on the device, and by a plain model of the equations.
#include "tests/shaders/gpu_revectorization_helper.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon::test {
namespace {

constexpr const char* kKernel = R"(
layout(local_size_x = 64) in;
struct Result {
  vec4 distances;
  vec2 r, filtered_r;
  float conservative, nonconservative, filtered, lit;
  vec4 discontinuous;
};
layout(set = 0, binding = 0, std430) readonly buffer Map { int width, height, max_size, mirror_c; uint bits[]; };
layout(set = 0, binding = 1, std430) readonly buffer Points { vec2 points[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Results { Result results[]; };

bool rbsm_lit(ivec2 texel, inout float lowering) {
  texel = clamp(texel, ivec2(0), ivec2(width, height) - 1);
  return bits[texel.y * width + texel.x] != 0u;
}

#include "lib/revectorization.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= points.length()) return;
  ivec2 texel = ivec2(floor(points[i]));
  vec2 c = fract(points[i]);
  if (mirror_c != 0) c = 1.0 - c;
  float unused = 0.0;
  bool lit = rbsm_lit(texel, unused);
  bvec4 d = rbsm_discontinuity(texel, lit);
  Result a;
  a.distances = rbsm_distances(texel, c, lit, d, max_size);
  a.r = rbsm_relative_position(a.distances, lit, max_size);
  a.filtered_r = rbsm_relative_position_filtered(a.distances, max_size);
  a.lit = float(lit);
  a.discontinuous = vec4(float(any(d)), 0.0, 0.0, 0.0);
  a.conservative = a.nonconservative = a.filtered = a.lit;
  if (any(d)) {
    a.conservative = rbsm_conservative(lit, a.r);
    a.nonconservative = rbsm_nonconservative(lit, a.r);
    a.filtered = rbsm_filtered(lit, a.filtered_r);
  }
  results[i] = a;
}
)";

// ---- The equations, in double precision. ----

constexpr int kSteps[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};  // left, right, top, bottom

using Discontinuity = std::array<bool, 4>;

Discontinuity discontinuity(const VisibilityMap& map, int x, int y) {  // (3.3)
  Discontinuity d{};
  for (int k = 0; k < 4; ++k) d[size_t(k)] = map.lit(x, y) ^ map.lit(x + kSteps[k][0], y + kSteps[k][1]);
  return d;
}

// 3.1.3 and 3.2.3: texels are passed while they have the fragment's visibility and share a discontinuity
// direction.
double signed_distance(const VisibilityMap& map, int x, int y, int direction, double within_texel,
                       int max_size) {
  const Discontinuity own = discontinuity(map, x, y);
  const bool visibility = map.lit(x, y);
  int passed = 0;
  while (passed < max_size) {
    const int nx = x + (passed + 1) * kSteps[direction][0], ny = y + (passed + 1) * kSteps[direction][1];
    if (map.lit(nx, ny) != visibility) return passed + within_texel;
    const Discontinuity there = discontinuity(map, nx, ny);
    bool common = false;
    for (size_t k = 0; k < 4; ++k) common |= own[k] && there[k];
    if (!common) break;
    ++passed;
  }
  return -(passed + within_texel);
}

double shape(double d1, double d2) {  // (3.4)
  if (d1 > 0 && d2 > 0) return -2;
  if (d1 < 0 && d2 < 0) return 0;
  return 1;
}

double clamped_length(double d1, double d2,
                      int max_size) {  // denominator of (3.5), clamped as in listing A.4
  return std::min(std::abs(d1) + std::abs(d2), double(max_size));
}

double relative(double d1, double d2, double v, int max_size) {  // (3.5)
  const double t = shape(d1, d2);
  return std::max(t, 2 * v - 1) * std::abs(std::max(t * d1, t * d2)) / clamped_length(d1, d2, max_size);
}

double relative_filtered(double d1, double d2, int max_size) {  // (4.1)
  const double t = shape(d1, d2);
  return t * std::max(t * d1, t * d2) / clamped_length(d1, d2, max_size);
}

double conservative(double v, double rx, double ry) {  // (3.6)
  return v == 0 || (rx * ry > 0 && 1 - rx > ry) ? 0 : 1;
}

double non_conservative(double v, double rx, double ry) {  // (3.9)
  const double ax = std::abs(rx), ay = std::abs(ry);
  return rx * ry == 2 * v || (ax * ay > 0 && (1 - v) + (2 * v - 1) * (ax + ay) < 0.5) ? 0 : 1;
}

double filtered(double v, double rx, double ry) {  // (4.2)
  if (rx * ry < 0) return 1 - v + (2 * v - 1) * std::max(rx, ry);
  if (rx * ry == 0) return v;
  return std::min(std::max(1 - v + (2 * v - 1) * (rx + ry), 0.0), 1.0);
}

}  // namespace

bool VisibilityMap::lit(int x, int y) const {
  return rows[size_t(std::clamp(y, 0, height() - 1))][size_t(std::clamp(x, 0, width() - 1))] == '.';
}

std::vector<Revectorized> revectorize_on_device(const VisibilityMap& map, const std::vector<Point>& points,
                                                int max_size, bool mirror_c) {
  const Kernel kernel("revectorize", kKernel, 3);
  std::vector<int32_t> words{map.width(), map.height(), max_size, mirror_c ? 1 : 0};
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) words.push_back(map.lit(x, y));
  return kernel.run<Revectorized>({bytes_of(words), bytes_of(points)}, points.size());
}

Revectorized revectorize_by_equations(const VisibilityMap& map, Point point, int max_size) {
  const int x = int(std::floor(point.x)), y = int(std::floor(point.y));
  const double cx = double(point.x) - x, cy = double(point.y) - y;  // (3.1)
  const double within[4] = {cx, 1 - cx, cy, 1 - cy};
  double d[4];
  for (int k = 0; k < 4; ++k) d[k] = signed_distance(map, x, y, k, within[k], max_size);
  const double v = map.lit(x, y);
  const double rx = relative(d[0], d[1], v, max_size), ry = relative(d[2], d[3], v, max_size);
  const double fx = relative_filtered(d[0], d[1], max_size), fy = relative_filtered(d[2], d[3], max_size);
  const Discontinuity own = discontinuity(map, x, y);
  const bool any = std::find(own.begin(), own.end(), true) != own.end();
  return {{float(d[0]), float(d[1]), float(d[2]), float(d[3])},
          {float(rx), float(ry)},
          {float(fx), float(fy)},
          float(any ? conservative(v, rx, ry) : v),
          float(any ? non_conservative(v, rx, ry) : v),
          float(any ? filtered(v, fx, fy) : v),
          float(v),
          any ? 1.0f : 0.0f,
          {}};
}

VisibilityMap Symmetry::operator()(const VisibilityMap& map) const {
  const int w = transpose ? map.height() : map.width(), h = transpose ? map.width() : map.height();
  VisibilityMap result{std::vector<std::string>(size_t(h), std::string(size_t(w), '.'))};
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const Point p = (*this)(map, {float(x) + 0.5f, float(y) + 0.5f});
      result.rows[size_t(p.y)][size_t(p.x)] = map.rows[size_t(y)][size_t(x)];
    }
  return result;
}

Point Symmetry::operator()(const VisibilityMap& original, Point p) const {
  float w = float(original.width()), h = float(original.height());
  if (transpose) std::swap(p.x, p.y), std::swap(w, h);
  return {mirror_x ? w - p.x : p.x, mirror_y ? h - p.y : p.y};
}

Revectorized Symmetry::operator()(Revectorized value) const {
  if (transpose) {
    std::swap(value.distances[0], value.distances[2]), std::swap(value.distances[1], value.distances[3]);
    std::swap(value.r[0], value.r[1]), std::swap(value.filtered_r[0], value.filtered_r[1]);
  }
  if (mirror_x) std::swap(value.distances[0], value.distances[1]);
  if (mirror_y) std::swap(value.distances[2], value.distances[3]);
  return value;
}

std::array<Symmetry, 8> all_symmetries() {
  std::array<Symmetry, 8> all;
  for (unsigned i = 0; i < 8; ++i) all[i] = {(i & 4) != 0, (i & 1) != 0, (i & 2) != 0};
  return all;
}

}  // namespace gnomon::test
