// The scene lattice: a vault and a ring of laths with many small holes.
#include <cmath>
#include <numbers>

#include "tools/scenes/scenes.h"
#include "tools/scenes/shapes.h"

namespace gnomon::generate {
namespace {

constexpr double kPi = std::numbers::pi;

// A barrel vault that also bends along its length.
glm::dvec3 vault(double u, double v) {
  const double angle = kPi * (1.0 - u), bend = (v - 0.5) * 1.5;
  const double radius = 3.0 - 0.25 * std::cos(2 * kPi * v);
  const double side = radius * std::cos(angle) + 9.0;
  return {side * std::cos(bend) - 9.0, radius * std::sin(angle), -side * std::sin(bend)};
}

glm::dvec3 ring(double u, double v) {
  const double around = 2 * kPi * u, across = 2 * kPi * v;
  const double r = 1.5 + 0.55 * std::cos(across);
  return {r * std::cos(around), r * std::sin(around), 0.55 * std::sin(across)};
}

}  // namespace

std::string lattice() {
  Builder builder("lattice");
  Shape ground, arch, torus;
  add_ground(ground, {9.5, 9.5}, 0.0, 8);
  add_lattice(arch, vault, {26, 20, false, false, 0.08, 0.16});
  add_lattice(torus, ring, {30, 10, true, true, 0.06, 0.17});
  builder.add("ground", ground, builder.material({"ground", {0.75, 0.72, 0.66}, true, {}, {}}));
  builder.add("vault", arch, builder.material({"vault", {0.55, 0.57, 0.6}, false, {}, {}}));
  const uint32_t brass = builder.material({"ring", {0.75, 0.55, 0.2}, false, {}, {}});
  builder.node("ring", builder.mesh("ring", torus, brass),
               {{-4.6, 2.1, 5.0}, turn(-25, {0, 1, 0}), glm::dvec3(1.0)});
  builder.camera({5.0, 6.2, 13.0}, {0.4, 0.8, 1.6}, 45.0, 0.1);
  builder.spot({-13.0, 17.0, -9.0}, {0.8, 0.5, 1.8}, 50.0);
  return builder.glb();
}

}  // namespace gnomon::generate
