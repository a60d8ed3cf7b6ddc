// The scene fence: pickets, rails and posts, thin and regular.
#include "tools/scenes/scenes.h"
#include "tools/scenes/shapes.h"

namespace gnomon::generate {
namespace {

// A flat board with a pointed top, standing on y = 0; closed.
void add_picket(Shape& shape, double x, double height, double half_width, double half_depth) {
  add_extruded_strip(shape, {x - half_width, x, x + half_width}, {0.08, 0.08, 0.08},
                     {height - half_width, height, height - half_width}, half_depth, {});
}

Shape fence_section(int pickets, double length) {
  Shape shape;
  Random random(7);
  for (int i = 0; i < pickets; ++i) {
    const double x = length * ((i + 0.5) / pickets - 0.5);
    add_picket(shape, x, 2.0 + random.in(-0.06, 0.06), 0.11, 0.03);
  }
  return shape;
}

// Behind the pickets, half a hand apart, so that no two boxes touch.
Shape rails(double length) {
  Shape shape;
  for (const double y : {0.5, 1.45}) add_box(shape, {0, y, -0.085}, {0.5 * length, 0.07, 0.05});
  return shape;
}

Shape posts(double length) {
  Shape shape;
  for (const double x : {-0.5, 0.0, 0.5}) {
    add_box(shape, {x * length, 1.05, -0.25}, {0.1, 1.05, 0.1});
    add_sphere(shape, {x * length, 2.24, -0.25}, glm::dvec3(0.13), 2);
  }
  return shape;
}

}  // namespace

std::string fence() {
  Builder builder("fence");
  Shape ground;
  add_ground(ground, {10.5, 9.0}, 0.0, 8);
  builder.add("lawn", ground, builder.material({"lawn", {0.35, 0.55, 0.25}, true, {}, {}}));
  const uint32_t paint = builder.material({"paint", {0.85, 0.83, 0.78}, false, {}, {}});
  const uint32_t wood = builder.material({"wood", {0.45, 0.3, 0.18}, false, {}, {}});
  const uint32_t section = builder.mesh("pickets", fence_section(28, 9.0), paint);
  const uint32_t rail = builder.mesh("rails", rails(9.2), wood),
                 post = builder.mesh("posts", posts(9.2), wood);
  const Placement front{{-1.2, 0, 0}, glm::dmat3(1.0), glm::dvec3(1.0)};
  const Placement side{{6.4, 0, -2.6}, turn(38, {0, 1, 0}), glm::dvec3(1.0)};
  for (const Placement& place : {front, side}) {
    builder.node("pickets", section, place);
    builder.node("rails", rail, place);
    builder.node("posts", post, place);
  }
  builder.camera({1.6, 4.6, 10.5}, {0.9, 0.6, 0.8}, 45.0, 0.1);
  builder.spot({-7.0, 15.0, -20.0}, {1.0, 0.0, 1.5}, 40.0);
  return builder.glb();
}

}  // namespace gnomon::generate
