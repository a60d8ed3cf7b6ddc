// The scene foliage: a tree of alpha-masked leaves.
#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/image/png.h"
#include "tools/scenes/scenes.h"
#include "tools/scenes/shapes.h"

namespace gnomon::generate {
namespace {

// A frame with random directions, z leaning upwards by `lean`.
glm::dmat3 random_frame(Random& random, double lean) {
  glm::dvec3 z;
  do {
    z = in_box(random, glm::dvec3(-1), glm::dvec3(1));
  } while (glm::dot(z, z) > 1.0 || glm::dot(z, z) < 0.01);
  z = glm::normalize(glm::normalize(z) + glm::dvec3(0, lean, 0) + glm::dvec3(0.01, 0, 0));
  const double height = random.in(-0.3, 0.3);
  const glm::dvec3 beside(random.in(-1, 1), height, 1.1);
  const glm::dvec3 x = glm::normalize(glm::cross(beside, z));
  return {x, glm::cross(z, x), z};
}

// Two triangles folded along the midrib.
void add_leaf(Shape& shape, const glm::dvec3& at, const glm::dmat3& frame, double length) {
  const auto p = [&](double x, double y, double z) { return at + frame * (length * glm::dvec3(x, y, z)); };
  const glm::dvec3 base = p(0, 0, 0), tip = p(0, 1, -0.1), left = p(-0.28, 0.45, 0.1),
                   right = p(0.28, 0.45, 0.1);
  const uint32_t first = shape.vertex(base, frame[2]);
  for (const glm::dvec3& corner : {right, tip, left}) shape.vertex(corner, frame[2]);
  shape.triangle(first, first + 1, first + 2);
  shape.triangle(first, first + 2, first + 3);
}

// A card for the alpha-masked spray of leaves.
void add_card(Shape& shape, const glm::dvec3& at, const glm::dmat3& frame, double size) {
  const uint32_t first = static_cast<uint32_t>(shape.positions.size());
  for (const glm::dvec2& uv : {glm::dvec2(0, 1), glm::dvec2(1, 1), glm::dvec2(1, 0), glm::dvec2(0, 0)}) {
    shape.vertex(at + frame * glm::dvec3((uv.x - 0.5) * size, (1.0 - uv.y) * size, 0), frame[2]);
    shape.uvs.push_back(uv);
  }
  shape.triangle(first, first + 1, first + 2);
  shape.triangle(first, first + 2, first + 3);
}

// Distance-like measure of a lens-shaped leaf from `base` to `tip`: below 0 inside.
double leaf_measure(const glm::dvec2& p, const glm::dvec2& base, const glm::dvec2& tip) {
  const glm::dvec2 axis = tip - base;
  const double t = glm::dot(p - base, axis) / glm::dot(axis, axis);
  if (t <= 0 || t >= 1) return 1.0;
  const double across = std::abs((p.x - base.x) * axis.y - (p.y - base.y) * axis.x) / glm::length(axis);
  return across - 0.9 * glm::length(axis) * t * (1.0 - t) * (1.15 - 0.5 * t);
}

// A stem with five leaves, 64 x 64, alpha 0 or 255 softened over one texel.
std::string spray_png() {
  constexpr int size = 64;
  const std::vector<std::pair<glm::dvec2, glm::dvec2>> leaves = {
      {{.5, .25}, {.12, .1}}, {{.5, .25}, {.88, .1}}, {{.5, .5}, {.06, .52}}, {{.5, .5}, {.94, .52}},
      {{.5, .55}, {.22, .9}}, {{.5, .55}, {.78, .9}}, {{.5, .6}, {.5, .99}}};
  std::vector<uint8_t> pixels;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const glm::dvec2 p((x + 0.5) / size, 1.0 - (y + 0.5) / size);
      double measure = p.y < 0.65 ? std::abs(p.x - 0.5) - 0.015 : 1.0;
      for (const auto& [base, tip] : leaves) measure = std::min(measure, leaf_measure(p, base, tip));
      const double alpha = std::clamp(0.5 - measure * size, 0.0, 1.0);
      const double vein = 0.5 + 0.5 * std::abs(std::round(p.x * 8) - p.x * 8);
      for (const double c : {0.45 * vein, 0.75 * vein + 0.1, 0.2, alpha})
        pixels.push_back(static_cast<uint8_t>(std::lround(c * 255)));
    }
  }
  return png::encode(pixels, size, size, 4, "spray.png");
}

// Leaf positions crowd towards the surface of a crown of three ellipsoids.
glm::dvec3 in_crown(Random& random) {
  static constexpr double crowns[3][4] = {{0.0, 5.2, 0.0, 2.1}, {-1.3, 4.2, 0.5, 1.5}, {1.4, 4.4, -0.3, 1.6}};
  const auto& crown = crowns[random.next() % 3];
  const glm::dmat3 frame = random_frame(random, 0.0);
  return glm::dvec3(crown[0], crown[1], crown[2]) +
         frame[2] * (crown[3] * std::sqrt(random.in(0.15, 1.0))) * glm::dvec3(1, 0.8, 1);
}

Shape trunk() {
  Shape shape;
  add_cylinder(shape, {0, -0.1, 0}, {0.1, 3.4, 0}, 0.34, 0.2, 14);
  add_cylinder(shape, {0.08, 2.6, 0}, {-1.3, 4.3, 0.5}, 0.15, 0.06, 10);
  add_cylinder(shape, {0.08, 2.9, 0}, {1.5, 4.5, -0.3}, 0.15, 0.06, 10);
  add_cylinder(shape, {0.1, 3.2, 0}, {0, 5.8, 0}, 0.2, 0.05, 10);
  return shape;
}

}  // namespace

std::string foliage() {
  Builder builder("foliage");
  Random random(2024);
  Shape ground, leaves, shrubs, cards;
  add_ground(ground, {9.5, 9.0}, 0.0, 8);
  for (int i = 0; i < 3600; ++i) {
    const double size = random.in(0.22, 0.38);
    const glm::dmat3 frame = random_frame(random, 0.5);
    add_leaf(leaves, in_crown(random), frame, size);
  }
  for (int i = 0; i < 700; ++i) {
    const double size = random.in(0.4, 0.65);
    const glm::dmat3 frame = random_frame(random, 0.3);
    add_card(cards, in_crown(random), frame, size);
  }
  for (const glm::dvec3& at : {glm::dvec3(-4.2, 0, 1.6), glm::dvec3(3.8, 0, 2.4), glm::dvec3(4.8, 0, -2.2),
                               glm::dvec3(-2.4, 0, 4.2)}) {
    for (int i = 0; i < 350; ++i) {
      const glm::dmat3 way = random_frame(random, 0.6);
      const double size = random.in(0.2, 0.4);
      const glm::dmat3 frame = random_frame(random, 0.4);
      const glm::dvec3 upwards(way[2].x, std::abs(way[2].y), way[2].z);
      add_leaf(shrubs, at + upwards * random.in(0.2, 1.0), frame, size);
    }
    for (int i = 0; i < 120; ++i) {
      const double size = random.in(0.5, 0.8);
      const glm::dmat3 frame = random_frame(random, 0.0);
      add_card(cards, at + in_box(random, {-1.1, 0, -1.1}, {1.1, 0.5, 1.1}), frame, size);
    }
  }
  builder.add("ground", ground, builder.material({"ground", {0.6, 0.52, 0.38}, true, {}, {}}));
  builder.add("trunk", trunk(), builder.material({"bark", {0.3, 0.2, 0.13}, false, {}, {}}));
  builder.add("leaves", leaves, builder.material({"leaf", {0.25, 0.5, 0.15}, true, {}, {}}));
  builder.add("shrubs", shrubs, builder.material({"shrub", {0.35, 0.5, 0.12}, true, {}, {}}));
  const uint32_t spray = builder.texture("spray", spray_png());
  builder.add("sprays", cards, builder.material({"spray", {1, 1, 1}, true, 0.5, spray}));
  builder.camera({2.0, 7.5, 14.5}, {0.2, 2.0, 1.0}, 45.0, 0.1);
  builder.spot({-9.0, 20.0, -15.0}, {0.8, 1.0, 1.5}, 44.0);
  return builder.glb();
}

}  // namespace gnomon::generate
