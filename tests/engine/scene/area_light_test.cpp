// Shapes of area lights, their emission and their sample points.
#include "engine/scene/area_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/error.h"

namespace gnomon {
namespace {

using Shape = AreaLight::Shape;

AreaLight shape(Shape kind, double width, double height) { return {kind, width, height, {}, {}}; }

// Not convex: an arrow head with its notch below.
AreaLight arrow() { return polygon_light({{-0.75, -0.5}, {0.0, -0.25}, {0.75, -0.5}, {0.0, 0.75}}); }
constexpr double arrow_area = 0.5 * 1.5 * 1.25 - 0.5 * 1.5 * 0.25;

std::vector<AreaLight> one_of_each() {
  return {shape(Shape::rectangle, 2, 1), shape(Shape::disc, 2, 2), shape(Shape::sphere, 1, 1), arrow()};
}

bool near(const glm::dvec2& a, const glm::dvec2& b) { return glm::length(a - b) < 1e-12; }

TEST(AreaLight, PlacesOnTheBoundingRectangle) {
  const AreaLight area = shape(Shape::rectangle, 2, 1);
  EXPECT_EQ(place_on(area, {0, 0}), glm::dvec2(-1, -0.5));
  EXPECT_EQ(place_on(area, {1, 0}), glm::dvec2(1, -0.5));
  EXPECT_EQ(place_on(area, {0.5, 1}), glm::dvec2(0, 0.5));
}

TEST(AreaLight, BordersBelongToTheLight) {
  const AreaLight rectangle = shape(Shape::rectangle, 2, 1), disc = shape(Shape::disc, 2, 2);
  for (const glm::dvec2& p : {glm::dvec2(1, 0.5), glm::dvec2(-1, -0.5), glm::dvec2(0, 0)})
    EXPECT_TRUE(on_light(rectangle, p));
  for (const glm::dvec2& p : {glm::dvec2(1.001, 0), glm::dvec2(0, -0.501)})
    EXPECT_FALSE(on_light(rectangle, p));
  for (int i = 0; i < 360; ++i) {
    const double a = i * std::numbers::pi / 180;
    EXPECT_TRUE(on_light(disc, {std::cos(a), std::sin(a)}));
    EXPECT_FALSE(on_light(disc, 1.0001 * glm::dvec2(std::cos(a), std::sin(a))));
  }
  const AreaLight head = arrow();
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec2 a = head.outline[i], b = head.outline[(i + 1) % 4];
    for (const double t : {0.0, 0.1, 1.0 / 3, 0.5, 0.9})
      EXPECT_TRUE(on_light(head, a + t * (b - a))) << i << ' ' << t;
  }
  EXPECT_TRUE(on_light(head, {0, 0}));
  EXPECT_TRUE(on_light(head, {0.6, -0.4}));
  EXPECT_FALSE(on_light(head, {0, -0.3}));  // in the notch
  EXPECT_FALSE(on_light(head, {0.5, 0.5}));
}

TEST(AreaLight, OrientationOfAnOutlineDoesNotMatter) {
  std::vector<glm::dvec2> turned = arrow().outline;
  std::reverse(turned.begin(), turned.end());
  const AreaLight a = arrow(), b = polygon_light(turned);
  EXPECT_EQ(coverage(a), coverage(b));
  for (int y = -10; y <= 10; ++y)
    for (int x = -10; x <= 10; ++x)
      EXPECT_EQ(on_light(a, {0.083 * x, 0.081 * y}), on_light(b, {0.083 * x, 0.081 * y})) << x << ' ' << y;
}

TEST(AreaLight, CoverageIsTheShareOfTheBoundingRectangle) {
  const AreaLight head = arrow();
  EXPECT_EQ(head.width, 1.5);
  EXPECT_EQ(head.height, 1.5);  // 2 * 0.75: the rectangle is centred on the light
  EXPECT_NEAR(coverage(head), arrow_area / 2.25, 1e-15);
  EXPECT_NEAR(coverage(shape(Shape::disc, 3, 3)), std::numbers::pi / 4, 1e-15);
  for (const AreaLight& area : one_of_each()) {
    int on = 0;
    constexpr int side = 500;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        on += on_light(area, place_on(area, {(x + 0.5) / side, (y + 0.5) / side}));
    EXPECT_NEAR(double(on) / (side * side), coverage(area), 2e-3);
  }
}

TEST(AreaLight, OutlinesThatCannotBeUsedSayWhy) {
  const double nan = std::nan("");
  const std::pair<std::vector<glm::dvec2>, const char*> cases[] = {
      {{{0, 0}, {1, 0}}, "2 corners"},
      {std::vector<glm::dvec2>(kMostCorners + 1), "corners"},
      {{{0, 0}, {1, 0}, {0, nan}}, "finite"},
      {{{-1, -1}, {1, -1}, {1, -1}, {0, 1}}, "coincide"},
      {{{-1, -1}, {1, -1}, {0, 1}, {-1, -1}}, "coincide"},  // closed twice
      {{{-1, -1}, {1, 1}, {1, -1}, {-1, 1}}, "edges 0 and 2"},
      {{{-1, -1}, {1, -1}, {1, 1}, {0, -1}, {-1, 1}}, "meet"},  // a corner touches an edge
      {{{-1, -1}, {1, -1}, {0.5, -1}, {0, 1}}, "turns back"},
      {{{-1, 0}, {1, 0}, {0, 0}}, "turns back"},
      {{{-1, -1}, {1, 1}, {1, 0.999}}, "covers"},
      {{{100, 100}, {101, 100}, {100, 101}}, "covers"},  // far off the centre
  };
  for (const auto& [outline, part] : cases)
    EXPECT_NE(outline_problem(outline).find(part), std::string::npos)
        << part << ": " << outline_problem(outline);
  EXPECT_EQ(outline_problem(arrow().outline), "");
  EXPECT_EQ(outline_problem({{0, 0}, {1, 0}, {0, 1}}), "");
}

TEST(AreaLight, BorderPointsAreOnTheBorderAndHullsHoldThem) {
  for (const AreaLight& area : one_of_each()) {
    Bounds hull;
    for (const glm::dvec3& p : enclosing_points(area)) hull.add(p);
    for (const glm::dvec3& p : border_points(area)) {
      EXPECT_TRUE(glm::all(glm::lessThanEqual(hull.min, p)) && glm::all(glm::lessThanEqual(p, hull.max)));
      EXPECT_TRUE(on_light(area, glm::dvec2(p)));
      if (area.shape == Shape::sphere)
        EXPECT_NEAR(glm::length(p), 0.5, 1e-15);
      else
        EXPECT_FALSE(on_light(area, 1.001 * glm::dvec2(p)));
    }
  }
  EXPECT_EQ(enclosing_points(shape(Shape::sphere, 2, 2)).size(), 8u);
}

TEST(AreaPoints, GridsKeepWhatIsOnTheLight) {
  const AreaLight rectangle = shape(Shape::rectangle, 2, 1), disc = shape(Shape::disc, 2, 2);
  const auto centres = area_points(rectangle, 16, AreaPattern::grid_centres);
  ASSERT_EQ(centres.size(), 16u);
  EXPECT_TRUE(near(centres[0], {-0.75, -0.375}));
  EXPECT_TRUE(near(centres[1], {-0.25, -0.375}));
  EXPECT_TRUE(near(centres[15], {0.75, 0.375}));
  const auto corners = area_points(rectangle, 9, AreaPattern::grid_corners);
  ASSERT_EQ(corners.size(), 9u);
  EXPECT_TRUE(near(corners[0], {-1, -0.5}));
  EXPECT_TRUE(near(corners[4], {0, 0}));
  EXPECT_TRUE(near(corners[8], {1, 0.5}));
  EXPECT_EQ(area_points(disc, 9, AreaPattern::grid_corners).size(), 5u);    // a cross
  EXPECT_EQ(area_points(disc, 16, AreaPattern::grid_centres).size(), 12u);  // without the corners
  for (const AreaPattern pattern : {AreaPattern::grid_centres, AreaPattern::grid_corners})
    EXPECT_EQ(area_points(rectangle, 1, pattern), std::vector<glm::dvec2>{glm::dvec2(0.0)});
  EXPECT_THROW(area_points(disc, 15, AreaPattern::grid_centres), Error);
  EXPECT_TRUE(area_points(disc, 0, AreaPattern::grid_centres).empty());
}

TEST(AreaPoints, SobolGivesAsManyAsAskedOnTheLight) {
  for (const AreaLight& area : one_of_each()) {
    const auto points = area_points(area, 300, AreaPattern::sobol, 7);
    ASSERT_EQ(points.size(), 300u);
    for (const glm::dvec2& p : points) EXPECT_TRUE(on_light(area, p));
    EXPECT_EQ(points, area_points(area, 300, AreaPattern::sobol, 7));
    EXPECT_NE(points, area_points(area, 300, AreaPattern::sobol, 8));
    const auto fewer = area_points(area, 100, AreaPattern::sobol, 7);  // one sequence
    EXPECT_TRUE(std::equal(fewer.begin(), fewer.end(), points.begin()));
  }
  AreaLight broken = arrow();
  broken.outline = {{-1, 0}, {1, 0}, {0, 0}};
  EXPECT_THROW(area_points(broken, 4, AreaPattern::sobol), Error);
}

// The share of points in a part of the light against the part's share of its area: random points would be off
// by sqrt(s (1 - s) / n), here 0.014 for a half; low-discrepancy ones are much closer. The border that
// rejection cuts costs some of it.
TEST(AreaPoints, SobolPointsAreEven) {
  constexpr uint32_t n = 1024;
  for (const AreaLight& area : one_of_each()) {
    for (const double turn : {0.0, 0.4, 1.1, 1.9, 2.7}) {
      const glm::dvec2 normal(std::cos(turn), std::sin(turn));
      for (const double offset : {-0.2, 0.0, 0.15}) {
        const auto inside = [&](const glm::dvec2& p) { return glm::dot(p, normal) < offset * area.width; };
        double part = 0, all = 0;
        for (int y = 0; y < 400; ++y)
          for (int x = 0; x < 400; ++x) {
            const glm::dvec2 p = place_on(area, {(x + 0.5) / 400, (y + 0.5) / 400});
            if (!on_light(area, p)) continue;
            all += 1;
            part += inside(p);
          }
        for (const uint32_t seed : {0u, 1u, 2u}) {
          const auto points = area_points(area, n, AreaPattern::sobol, seed);
          const double share = double(std::count_if(points.begin(), points.end(), inside)) / n;
          EXPECT_NEAR(share, part / all, 0.011) << int(area.shape) << ' ' << turn << ' ' << offset;
        }
      }
    }
  }
}

TEST(AreaPoints, ConcentricDiscKeepsAreas) {
  int inner = 0, right = 0;
  constexpr int side = 400;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const glm::dvec2 p = concentric_disc({(x + 0.5) / side, (y + 0.5) / side});
      ASSERT_LE(glm::length(p), 1.0);
      inner += glm::length(p) < 0.5;
      right += p.x > 0.5;
    }
  EXPECT_NEAR(double(inner) / (side * side), 0.25, 1e-3);
  const double segment = (std::acos(0.5) - 0.5 * std::sqrt(0.75)) / std::numbers::pi;
  EXPECT_NEAR(double(right) / (side * side), segment, 1e-3);
  EXPECT_EQ(concentric_disc({0.5, 0.5}), glm::dvec2(0.0));
  EXPECT_TRUE(near(concentric_disc({1, 0.5}), {1, 0}));
  EXPECT_TRUE(near(concentric_disc({0.5, 0}), {0, -1}));
}

// 2 x 2 panes, row 0 first: red, green / blue, white.
struct Window {
  Scene scene;
  AreaLight area = shape(Shape::rectangle, 2, 1);
  explicit Window(bool nearest) {
    Texture texture;
    texture.width = texture.height = 2;
    texture.rgba = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 0, 255, 255, 255, 255};
    texture.nearest = nearest;
    scene.textures.push_back(texture);
    area.emission = 0;
  }
};

TEST(AreaEmission, RowZeroIsAtTheTop) {
  for (const bool nearest : {true, false}) {
    const Window w(nearest);  // texel centres are at (+-0.5, +-0.25)
    EXPECT_EQ(emission_at(w.scene, w.area, {-0.5, 0.25}), glm::dvec3(1, 0, 0));
    EXPECT_EQ(emission_at(w.scene, w.area, {0.5, 0.25}), glm::dvec3(0, 1, 0));
    EXPECT_EQ(emission_at(w.scene, w.area, {-0.5, -0.25}), glm::dvec3(0, 0, 1));
    EXPECT_EQ(emission_at(w.scene, w.area, {0.5, -0.25}), glm::dvec3(1));
    EXPECT_EQ(emission_at(w.scene, w.area, {-1, 0.5}), glm::dvec3(1, 0, 0));  // clamped, never repeated
    EXPECT_EQ(emission_at(w.scene, w.area, {1, -0.5}), glm::dvec3(1));
    EXPECT_EQ(mean_emission(w.scene, w.area), glm::dvec3(0.5));
  }
  const Window linear(false);
  EXPECT_EQ(emission_at(linear.scene, linear.area, {0, 0.25}), glm::dvec3(0.5, 0.5, 0));
  EXPECT_EQ(emission_at(linear.scene, linear.area, {0, 0}), glm::dvec3(0.5));
}

TEST(AreaEmission, IsLinearLight) {
  Window w(true);
  w.scene.textures[0].rgba[0] = 188;  // sRGB: ((188 / 255 + 0.055) / 1.055) ^ 2.4
  EXPECT_NEAR(emission_at(w.scene, w.area, {-0.5, 0.25}).r, 0.502886, 1e-6);
  EXPECT_EQ(emission_weight({1, 1, 1}), 1.0);
  EXPECT_DOUBLE_EQ(emission_weight({0, 1, 0}), 0.7152);
  w.area.emission.reset();
  EXPECT_EQ(emission_at(w.scene, w.area, {0, 0}), glm::dvec3(1.0));
  EXPECT_EQ(mean_emission(w.scene, w.area), glm::dvec3(1.0));
}

TEST(LightScale, ScalesEveryAreaAndNothingElse) {
  Scene scene;
  scene.lights.resize(3);
  scene.lights[0].area = AreaLight{AreaLight::Shape::disc, 2, 4, {}, {}};
  scene.lights[1].area = polygon_light({{-1, -1}, {1, -1}, {0, 1}});
  const Scene twice = with_light_scale(scene, 2);
  EXPECT_EQ(twice.lights[0].area->width, 4);
  EXPECT_EQ(twice.lights[0].area->height, 8);
  EXPECT_EQ(*twice.lights[1].area, polygon_light({{-2, -2}, {2, -2}, {0, 2}}));
  EXPECT_FALSE(twice.lights[2].area);
  EXPECT_EQ(twice.lights[0].intensity, scene.lights[0].intensity);
  EXPECT_EQ(*with_light_scale(scene, 1).lights[0].area, *scene.lights[0].area);
  for (const Light& light : with_light_scale(scene, 0).lights) EXPECT_FALSE(light.area);
  // Of the sun its penumbrae's widths, which go with the tangent of half its diameter.
  scene.lights[2].type = LightType::directional;
  scene.lights[2].area = angular_disc(0.01);
  EXPECT_NEAR(std::tan(0.5 * angular_diameter(*with_light_scale(scene, 30).lights[2].area)),
              30 * std::tan(0.005), 1e-15);
  EXPECT_THROW(with_light_scale(scene, -1), Error);
  EXPECT_THROW(with_light_scale(scene, std::nan("")), Error);
  EXPECT_THROW(with_light_scale(scene, 1e308), Error);
}

TEST(AreaEmission, CellsAreExactMeans) {
  for (const bool nearest : {true, false}) {
    Window w(nearest);
    Texture& texture = w.scene.textures[0];
    texture.width = 5, texture.height = 3;
    texture.rgba.clear();
    for (uint32_t i = 0; i < 60; ++i) texture.rgba.push_back(static_cast<uint8_t>(i * 97 % 251));
    const std::pair<glm::dvec2, glm::dvec2> cells[] = {{{-1, -0.5}, {1, 0.5}},
                                                       {{-0.3, -0.1}, {0.35, 0.4}},
                                                       {{0.9, 0.4}, {1, 0.5}},
                                                       {{-0.01, 0}, {0.01, 0.02}}};
    for (const auto& [low, high] : cells) {
      glm::dvec3 sum(0.0);
      constexpr int side = 600;
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          sum += emission_at(w.scene, w.area,
                             low + (high - low) * glm::dvec2((x + 0.5) / side, (y + 0.5) / side));
      const glm::dvec3 exact = emission_in(w.scene, w.area, low, high);
      EXPECT_LT(glm::length(exact - sum / double(side * side)), 2e-3) << nearest << ' ' << low.x;
    }
    glm::dvec3 cells_mean(0.0);  // 7 x 4 cells make the whole
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 7; ++x)
        cells_mean += emission_in(w.scene, w.area, place_on(w.area, {x / 7.0, y / 4.0}),
                                  place_on(w.area, {(x + 1) / 7.0, (y + 1) / 4.0})) /
                      28.0;
    EXPECT_LT(glm::length(cells_mean - mean_emission(w.scene, w.area)), 1e-12);
    // What sticks out does not count.
    EXPECT_EQ(emission_in(w.scene, w.area, {-9, -9}, {9, 9}), mean_emission(w.scene, w.area));
  }
}

}  // namespace
}  // namespace gnomon
