// Shapes for the generated scenes; closed ones are watertight.
#include "tools/scenes/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <numbers>

namespace gnomon::generate {
namespace {

constexpr double kPi = std::numbers::pi;

glm::dvec3 patch_normal(const Patch& patch, double u, double v) {
  const double h = 1e-4;
  const glm::dvec3 du = patch(u + h, v) - patch(u - h, v), dv = patch(u, v + h) - patch(u, v - h);
  return glm::normalize(glm::cross(du, dv));
}

// Lines of a lattice along one direction: two per cell inside it, one between cells.
std::vector<double> lattice_lines(int cells, double rim, bool closed) {
  std::vector<double> lines;
  for (int i = 0; i < cells; ++i)
    for (const double offset : {0.0, rim, 1.0 - rim}) lines.push_back((i + offset) / cells);
  if (!closed) lines.push_back(1.0);
  return lines;
}

// Grid of a lattice's corners on both sides of its patch.
class LatticeMaker {
 public:
  LatticeMaker(Shape& shape, const Patch& patch, const Lattice& lattice)
      : shape_(shape),
        lattice_(lattice),
        us_(lattice_lines(lattice.n, lattice.hole, lattice.closed_u)),
        vs_(lattice_lines(lattice.m, lattice.hole, lattice.closed_v)) {
    for (const double v : vs_) {
      for (const double u : us_) {
        const glm::dvec3 p = patch(u, v), n = patch_normal(patch, u, v);
        outer_.push_back(shape.vertex(p + n * (0.5 * lattice.thickness), n));
        inner_.push_back(shape.vertex(p - n * (0.5 * lattice.thickness), -n));
      }
    }
  }

  void make() {
    for (int j = 0; j < 3 * lattice_.m; ++j) {
      for (int i = 0; i < 3 * lattice_.n; ++i) {
        if (hole(i, j)) continue;
        const size_t a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
        face(outer_[a], outer_[b], outer_[c], outer_[d]);
        face(inner_[d], inner_[c], inner_[b], inner_[a]);
        if (open(i, j - 1)) wall(a, b);
        if (open(i + 1, j)) wall(b, c);
        if (open(i, j + 1)) wall(c, d);
        if (open(i - 1, j)) wall(d, a);
      }
    }
  }

 private:
  static bool hole(int i, int j) { return i % 3 == 1 && j % 3 == 1; }
  // Nothing there: a hole, or past an edge that does not close.
  bool open(int i, int j) const {
    const int n = 3 * lattice_.n, m = 3 * lattice_.m;
    if ((i < 0 || i >= n) && !lattice_.closed_u) return true;
    if ((j < 0 || j >= m) && !lattice_.closed_v) return true;
    return hole((i + n) % n, (j + m) % m);
  }
  size_t corner(int i, int j) const {
    return static_cast<size_t>(j) % vs_.size() * us_.size() + static_cast<size_t>(i) % us_.size();
  }
  void face(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    shape_.triangle(a, b, c);
    shape_.triangle(a, c, d);
  }
  // Along the edge from a to b of a cell to the left of it (seen from outside): the wall faces right.
  void wall(size_t a, size_t b) {
    const auto& p = shape_.positions;
    const glm::dvec3 oa = p[outer_[a]], ob = p[outer_[b]], ia = p[inner_[a]], ib = p[inner_[b]];
    shape_.quad(oa, ia, ib, ob);
  }

  Shape& shape_;
  const Lattice& lattice_;
  std::vector<double> us_, vs_;
  std::vector<uint32_t> outer_, inner_;
};

class Icosphere {
 public:
  Icosphere(Shape& shape, const glm::dvec3& centre, const glm::dvec3& radii)
      : shape_(shape), centre_(centre), radii_(radii) {}

  void make(int levels) {
    const double t = 0.5 * (1.0 + std::sqrt(5.0));
    for (const auto& [x, y, z] : std::initializer_list<std::array<double, 3>>{{-1, t, 0},
                                                                              {1, t, 0},
                                                                              {-1, -t, 0},
                                                                              {1, -t, 0},
                                                                              {0, -1, t},
                                                                              {0, 1, t},
                                                                              {0, -1, -t},
                                                                              {0, 1, -t},
                                                                              {t, 0, -1},
                                                                              {t, 0, 1},
                                                                              {-t, 0, -1},
                                                                              {-t, 0, 1}})
      add(glm::dvec3(x, y, z));
    std::vector<std::array<uint32_t, 3>> faces = {
        {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (int level = 0; level < levels; ++level) {
      std::vector<std::array<uint32_t, 3>> finer;
      for (const auto& [a, b, c] : faces) {
        const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
      }
      faces = std::move(finer);
    }
    for (const auto& [a, b, c] : faces) shape_.triangle(first_ + a, first_ + b, first_ + c);
  }

 private:
  uint32_t add(const glm::dvec3& direction) {
    const glm::dvec3 d = glm::normalize(direction);
    if (directions_.empty()) first_ = static_cast<uint32_t>(shape_.positions.size());
    directions_.push_back(d);
    shape_.vertex(centre_ + d * radii_, glm::normalize(d / radii_));
    return static_cast<uint32_t>(directions_.size() - 1);
  }
  uint32_t middle(uint32_t a, uint32_t b) {
    const auto [found, fresh] = middles_.try_emplace(std::minmax(a, b), 0u);
    if (fresh) found->second = add(directions_[a] + directions_[b]);
    return found->second;
  }

  Shape& shape_;
  glm::dvec3 centre_, radii_;
  uint32_t first_ = 0;
  std::vector<glm::dvec3> directions_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles_;
};

}  // namespace

uint32_t Random::next() {
  const uint64_t old = state_;
  state_ = old * 6364136223846793005ull + 1442695040888963407ull;
  const uint32_t shifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27),
                 count = static_cast<uint32_t>(old >> 59);
  return shifted >> count | shifted << (-count & 31);
}

double Random::in(double low, double high) { return low + (high - low) * (next() * 0x1p-32); }

glm::dvec3 in_box(Random& random, const glm::dvec3& low, const glm::dvec3& high) {
  const double z = random.in(low.z, high.z), y = random.in(low.y, high.y), x = random.in(low.x, high.x);
  return {x, y, z};
}

glm::dmat3 turn(double angle, const glm::dvec3& axis) {
  return glm::dmat3(glm::rotate(glm::dmat4(1.0), angle / 180 * kPi, axis));
}

void add_box(Shape& shape, const glm::dvec3& centre, const glm::dvec3& half, const glm::dmat3& rotation) {
  const auto p = [&](double x, double y, double z) {
    return centre + rotation * (half * glm::dvec3(x, y, z));
  };
  shape.quad(p(-1, -1, 1), p(1, -1, 1), p(1, 1, 1), p(-1, 1, 1));
  shape.quad(p(1, -1, -1), p(-1, -1, -1), p(-1, 1, -1), p(1, 1, -1));
  shape.quad(p(1, -1, 1), p(1, -1, -1), p(1, 1, -1), p(1, 1, 1));
  shape.quad(p(-1, -1, -1), p(-1, -1, 1), p(-1, 1, 1), p(-1, 1, -1));
  shape.quad(p(-1, 1, 1), p(1, 1, 1), p(1, 1, -1), p(-1, 1, -1));
  shape.quad(p(-1, -1, -1), p(1, -1, -1), p(1, -1, 1), p(-1, -1, 1));
}

void add_cylinder(Shape& shape, const glm::dvec3& base, const glm::dvec3& top, double base_radius,
                  double top_radius, int sides) {
  const glm::dvec3 axis = glm::normalize(top - base);
  const glm::dvec3 x =
      glm::normalize(glm::cross(axis, std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
  const glm::dvec3 y = glm::cross(axis, x);
  const double slope = (base_radius - top_radius) / glm::length(top - base);
  const auto out = [&](int i) {
    const double angle = 2 * kPi * (i % sides) / sides;
    return x * std::cos(angle) + y * std::sin(angle);
  };
  const uint32_t first = static_cast<uint32_t>(shape.positions.size());
  const uint32_t count = static_cast<uint32_t>(sides);
  for (int i = 0; i < sides; ++i) {
    const glm::dvec3 n = glm::normalize(out(i) + axis * slope);
    shape.vertex(base + out(i) * base_radius, n);
    shape.vertex(top + out(i) * top_radius, n);
  }
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t a = first + 2 * i, b = first + 2 * ((i + 1) % count);
    shape.triangle(a, b, b + 1);
    shape.triangle(a, b + 1, a + 1);
  }
  for (const bool upper : {false, true}) {
    const glm::dvec3 n = upper ? axis : -axis;
    const uint32_t middle = shape.vertex(upper ? top : base, n);
    for (int i = 0; i < sides; ++i)
      shape.vertex(upper ? top + out(i) * top_radius : base + out(i) * base_radius, n);
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t a = middle + 1 + i, b = middle + 1 + (i + 1) % count;
      upper ? shape.triangle(middle, a, b) : shape.triangle(middle, b, a);
    }
  }
}

void add_sphere(Shape& shape, const glm::dvec3& centre, const glm::dvec3& radii, int levels) {
  Icosphere(shape, centre, radii).make(levels);
}

void add_ground(Shape& shape, const glm::dvec2& half, double height, int cells) {
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const auto p = [&](int a, int b) {
        return glm::dvec3(half.x * (2.0 * a / cells - 1), height, half.y * (2.0 * b / cells - 1));
      };
      shape.quad(p(i, j + 1), p(i + 1, j + 1), p(i + 1, j), p(i, j));
    }
  }
}

void add_patch(Shape& shape, const Patch& patch, int n, int m) {
  const uint32_t first = static_cast<uint32_t>(shape.positions.size()), row = static_cast<uint32_t>(n + 1);
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) {
      const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / m;
      shape.vertex(patch(u, v), patch_normal(patch, u, v));
    }
  for (uint32_t j = 0; j < static_cast<uint32_t>(m); ++j) {
    for (uint32_t i = 0; i + 1 < row; ++i) {
      const uint32_t a = first + j * row + i;
      shape.triangle(a, a + 1, a + row + 1);
      shape.triangle(a, a + row + 1, a + row);
    }
  }
}

void add_lattice(Shape& shape, const Patch& patch, const Lattice& lattice) {
  LatticeMaker(shape, patch, lattice).make();
}

void add_extruded_strip(Shape& shape, const std::vector<double>& xs, const std::vector<double>& lower,
                        const std::vector<double>& upper, double half_depth, const Placement& placement) {
  const auto p = [&](size_t i, bool top, double z) {
    return placement.translation +
           placement.rotation * glm::dvec3(xs[i], top ? upper[i] : lower[i], z * half_depth);
  };
  for (size_t i = 0; i + 1 < xs.size(); ++i) {
    shape.quad(p(i, false, 1), p(i + 1, false, 1), p(i + 1, true, 1), p(i, true, 1));
    shape.quad(p(i + 1, false, -1), p(i, false, -1), p(i, true, -1), p(i + 1, true, -1));
    shape.quad(p(i, true, 1), p(i + 1, true, 1), p(i + 1, true, -1), p(i, true, -1));
    shape.quad(p(i, false, -1), p(i + 1, false, -1), p(i + 1, false, 1), p(i, false, 1));
  }
  const size_t last = xs.size() - 1;
  shape.quad(p(0, false, -1), p(0, false, 1), p(0, true, 1), p(0, true, -1));
  shape.quad(p(last, false, 1), p(last, false, -1), p(last, true, -1), p(last, true, 1));
}

}  // namespace gnomon::generate
