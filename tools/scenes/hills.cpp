// The scene hills: terrain with conifers.
#include <cmath>

#include "tools/scenes/scenes.h"
#include "tools/scenes/shapes.h"

namespace gnomon::generate {
namespace {

constexpr double kHalfSide = 120.0;

double height(double x, double z) {
  return 5.0 * std::sin(0.035 * x + 0.6) * std::cos(0.041 * z - 0.4) + 2.2 * std::sin(0.09 * x - 0.05 * z) +
         0.5 * std::sin(0.31 * x + 0.7) * std::sin(0.27 * z) +
         0.15 * std::sin(0.9 * x) * std::cos(0.8 * z + 0.3);
}

glm::dvec3 terrain(double u, double v) {
  const double x = kHalfSide * (2 * u - 1), z = kHalfSide * (1 - 2 * v);
  return {x, height(x, z), z};
}

Shape conifer() {
  Shape shape;
  for (const double y : {1.0, 2.6, 4.2})
    add_cylinder(shape, {0, y, 0}, {0, y + 2.5, 0}, 1.9 - 0.3 * y, 0.03, 14);
  return shape;
}

}  // namespace

std::string hills() {
  Builder builder("hills");
  Shape ground, boulder, trunk;
  add_patch(ground, terrain, 120, 120);
  add_sphere(boulder, glm::dvec3(0.0), glm::dvec3(1.0), 2);
  add_cylinder(trunk, {0, -0.6, 0}, {0, 1.2, 0}, 0.28, 0.22, 10);
  builder.add("ground", ground, builder.material({"grass", {0.36, 0.46, 0.2}, true, {}, {}}));
  const uint32_t crown =
      builder.mesh("crown", conifer(), builder.material({"needles", {0.1, 0.26, 0.12}, false, {}, {}}));
  const uint32_t stem =
      builder.mesh("stem", trunk, builder.material({"bark", {0.3, 0.2, 0.13}, false, {}, {}}));
  const uint32_t rock =
      builder.mesh("rock", boulder, builder.material({"rock", {0.5, 0.48, 0.45}, false, {}, {}}));
  Random random(11);
  for (int i = 0; i < 170; ++i) {
    const double x = random.in(-85, 85), z = random.in(-95, 60);
    const glm::dvec3 at(x, height(x, z), z);
    const glm::dmat3 spin = turn(random.in(0, 360), {0, 1, 0});
    if (i % 3 != 0) {
      const Placement place{at, spin, glm::dvec3(random.in(0.7, 1.5))};
      builder.node("crown", crown, place);
      builder.node("stem", stem, place);
    } else {
      builder.node("rock", rock,
                   {at + glm::dvec3(0, 0.3, 0),
                    spin,
                    {random.in(0.5, 2.0), random.in(0.4, 1.3), random.in(0.5, 2.0)}});
    }
  }
  builder.camera({6.0, 24.0, 78.0}, {0.0, 1.0, 20.0}, 45.0, 0.5);
  builder.sun({0.75, -0.62, 0.55}, 0.9);
  return builder.glb();
}

}  // namespace gnomon::generate
