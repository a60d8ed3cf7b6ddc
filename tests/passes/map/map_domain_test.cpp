// What is warned of at load: lights that graze, and lights inside of casters.
#include "passes/map/map_domain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

// Far away, `degrees` from the normal of y = 0.
Light spot_at(double degrees, double distance = 1e4) {
  const double angle = degrees * std::numbers::pi / 180;
  Light light;
  light.world_from_light = analytic::frame(distance * glm::dvec3(std::sin(angle), std::cos(angle), 0),
                                           glm::dvec3(0), glm::dvec3(0, 0, 1));
  return light;
}

TEST(MapDomain, GrazedShareIsThatOfTheAreaBeyondTheSlope) {
  Scene scene;
  analytic::add(scene, analytic::square(1), {0, 0, 0});
  const double slope = 20;  // 87.14 degrees
  EXPECT_EQ(grazed_share(scene, spot_at(10), slope), 0);
  EXPECT_EQ(grazed_share(scene, spot_at(86.5), slope), 0);
  EXPECT_EQ(grazed_share(scene, spot_at(87.7), slope), 1);
  EXPECT_EQ(grazed_share(scene, spot_at(120), slope), 0);  // it faces away
  Light sun = spot_at(88);
  sun.type = LightType::directional;
  EXPECT_EQ(grazed_share(scene, sun, slope), 1);
  EXPECT_EQ(grazed_share(scene, sun, 40), 0);  // 88.57 degrees
}

TEST(MapDomain, GrazedShareOfAnAreaIsThatOfItsLowestPoint) {
  Scene scene;
  analytic::add(scene, analytic::square(1), {0, 0, 0});
  const Light light = spot_at(80, 7);  // 1.2 above the floor
  EXPECT_EQ(grazed_share(scene, light, 20), 0);
  EXPECT_EQ(grazed_share(scene, light, 20, {{0, 0, 0}, {0.5, 0.5, 0}}), 0);
  // Its lower side is 88 degrees from the floor's normal.
  EXPECT_EQ(grazed_share(scene, light, 20, {{1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}}), 1);
  // Farther down, a part between the two sides does; and nothing that is all below the floor.
  EXPECT_EQ(grazed_share(scene, light, 20, {{2, 2, 0}, {-2, -2, 0}, {2, -2, 0}, {-2, 2, 0}}), 1);
  EXPECT_EQ(grazed_share(scene, light, 20, {{-2, 2, 0}, {-2, -2, 0}}), 0);
}

TEST(MapDomain, GrazedShareWeighsByAreaAndKnowsFrontsFromBacks) {
  Scene scene;
  analytic::add(scene, analytic::square(2), {0, 0, 0});  // area 16, grazed
  analytic::add(scene, analytic::square(1), {0, 0, 0});  // area 4, turned towards the light
  scene.instances[1].world_from_object =
      glm::rotate(glm::dmat4(1.0), -0.5 * std::numbers::pi, glm::dvec3(0, 0, 1));
  EXPECT_NEAR(grazed_share(scene, spot_at(88), 20), 0.8, 1e-12);
  // Mirrored, the second one's front looks the other way.
  scene.instances[1].world_from_object *= glm::scale(glm::dmat4(1.0), glm::dvec3(1, -1, 1));
  EXPECT_EQ(grazed_share(scene, spot_at(88), 20), 1);
  scene.materials[scene.meshes[1].material].double_sided = true;
  EXPECT_NEAR(grazed_share(scene, spot_at(88), 20), 0.8, 1e-12);
}

TEST(MapDomain, GrazedShareOfNothingIsNone) { EXPECT_EQ(grazed_share(Scene(), spot_at(88), 20), 0); }

TEST(MapDomain, FindsTheClosedCasterAroundALight) {
  Scene scene;
  analytic::add(scene, analytic::square(5), {0, 0, 0});
  analytic::add(scene, analytic::sphere(1, 12, 24), {3, 2, 0});
  Light light;
  const auto at = [&](const glm::dvec3& place) {
    light.world_from_light[3] = glm::dvec4(place, 1.0);
    return surrounding_caster(scene, light);
  };
  EXPECT_EQ(at({3, 2, 0}), &scene.instances[1]);
  EXPECT_EQ(at({3.5, 2.5, 0.3}), &scene.instances[1]);
  EXPECT_EQ(at({3.8, 2.8, 0.8}), nullptr);  // in the corner of its box
  EXPECT_EQ(at({0, 2, 0}), nullptr);
  EXPECT_EQ(at({0, 0, 0}), nullptr);  // an open mesh surrounds nothing
  light.type = LightType::directional;
  EXPECT_EQ(at({3, 2, 0}), nullptr);
}

}  // namespace
}  // namespace gnomon
