// The scene colonnade: columns, arches and a vault.
#include <cmath>
#include <numbers>

#include "tools/scenes/scenes.h"
#include "tools/scenes/shapes.h"

namespace gnomon::generate {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kBays = 7;
constexpr double kBay = 3.0, kArchRadius = 1.15, kSpring = 3.2, kTop = 5.0,
                 kAisle = 2.4;  // half width of the aisle

double column_x(int i) { return kBay * (i - 0.5 * kBays); }

// Columns with a square plinth and capital, a gap apart from each other so that every part is closed by
// itself.
Shape columns(double z) {
  Shape shape;
  for (int i = 0; i <= kBays; ++i) {
    const double x = column_x(i);
    add_box(shape, {x, 0.15, z}, {0.34, 0.15, 0.34});
    add_cylinder(shape, {x, 0.29, z}, {x, kSpring - 0.24, z}, 0.25, 0.21, 28);
    add_box(shape, {x, kSpring - 0.13, z}, {0.34, 0.12, 0.34});
  }
  return shape;
}

// The wall above the columns, with a round arch in each bay.
Shape arches(double z) {
  std::vector<double> xs, lower, upper;
  const auto add = [&](double x, double y) { xs.push_back(x), lower.push_back(y), upper.push_back(kTop); };
  constexpr int steps = 28;
  add(column_x(0) - 0.34, kSpring);
  for (int i = 0; i < kBays; ++i) {
    const double centre = column_x(i) + 0.5 * kBay;
    for (int k = 0; k <= steps; ++k) {
      const double angle = kPi * (1.0 - static_cast<double>(k) / steps);
      add(centre + kArchRadius * std::cos(angle), kSpring + kArchRadius * std::sin(angle));
    }
  }
  add(column_x(kBays) + 0.34, kSpring);
  Shape shape;
  add_extruded_strip(shape, xs, lower, upper, 0.3, {{0, 0, z}, glm::dmat3(1.0), glm::dvec3(1.0)});
  return shape;
}

// A barrel vault over the aisle, along x; closed.
Shape vault() {
  std::vector<double> xs, lower, upper;
  constexpr int steps = 40;
  const double inner = kAisle + 0.25, outer = kAisle + 0.6;
  for (int k = 0; k <= steps; ++k) {
    const double angle = kPi * (1.0 - static_cast<double>(k) / steps);
    const double x = outer * std::cos(angle);
    xs.push_back(x);
    const double rise = inner * inner - x * x;
    lower.push_back(kTop + 0.05 + (rise > 0 ? 0.75 * std::sqrt(rise) : 0.0));
    upper.push_back(kTop + 0.3 + 0.75 * outer * std::sin(angle));
  }
  Shape shape;
  add_extruded_strip(shape, xs, lower, upper, 0.5 * kBay * kBays + 0.34,
                     {{0, 0, 0}, turn(90, {0, 1, 0}), glm::dvec3(1.0)});
  return shape;
}

Shape urns() {
  Shape shape;
  for (const double x : {-4.5, -1.5, 1.5}) {
    add_cylinder(shape, {x, 0.0, -1.1}, {x, 0.5, -1.1}, 0.42, 0.3, 24);
    add_sphere(shape, {x, 1.05, -1.1}, {0.5, 0.6, 0.5}, 3);
  }
  return shape;
}

}  // namespace

std::string colonnade() {
  Builder builder("colonnade");
  Shape ground, wall;
  add_ground(ground, {16.0, 14.0}, 0.0, 8);
  add_box(wall, {0, 0.5 * kTop, -kAisle - 0.25}, {0.5 * kBay * kBays + 0.34, 0.5 * kTop, 0.25});
  const uint32_t stone = builder.material({"stone", {0.78, 0.7, 0.58}, false, {}, {}});
  const uint32_t plaster = builder.material({"plaster", {0.82, 0.78, 0.72}, false, {}, {}});
  builder.add("floor", ground, builder.material({"floor", {0.62, 0.55, 0.48}, true, {}, {}}));
  builder.add("wall", wall, plaster);
  builder.add("columns", columns(kAisle), stone);
  builder.add("arches", arches(kAisle), stone);
  builder.add("vault", vault(), plaster);
  builder.add("urns", urns(), builder.material({"clay", {0.65, 0.35, 0.22}, false, {}, {}}));
  builder.camera({8.6, 2.3, 0.9}, {-2.5, 1.9, -0.9}, 55.0, 0.1);
  builder.spot({-9.0, 12.0, 26.0}, {1.0, 2.4, 0.0}, 44.0, 0.9);
  return builder.glb();
}

}  // namespace gnomon::generate
