// Lights are the same however they are turned about their own axis.
#include "engine/scene/light_roll.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

Scene lit(LightType type, const glm::dvec3& from, double roll) {
  Scene scene;
  scene.lights.push_back(analytic::light(type, from));
  glm::dmat4& frame = scene.lights[0].world_from_light;
  frame = frame * glm::rotate(glm::dmat4(1.0), roll, glm::dvec3(0, 0, 1));
  level_lights(scene);
  return scene;
}

TEST(LightRoll, SunsHaveTheAxesOfTheirDirection) {
  for (const glm::dvec3 from : {glm::dvec3(1, 2, 3), {0, 5, 0}, {0, -5, 0}, {-2, 0, 0}, {0.01, 5, 0}})
    for (double roll = 0.1; roll < 6.28; roll += 0.5) {
      const glm::dmat4 first = lit(LightType::directional, from, 1.234).lights[0].world_from_light;
      const glm::dmat4 frame = lit(LightType::directional, from, roll).lights[0].world_from_light;
      for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) EXPECT_NEAR(frame[c][r], first[c][r], 1e-15);
      EXPECT_NEAR(glm::determinant(frame), 1, 1e-12);
      EXPECT_NEAR(glm::distance(glm::dvec3(frame[2]), glm::normalize(from)), 0, 1e-12);
      EXPECT_GE(frame[1].y, -1e-12);
    }
}

TEST(LightRoll, PointLightsHaveTheWorldsAxes) {
  const Scene scene = lit(LightType::point, {1, 2, 3}, 0.4);
  EXPECT_EQ(glm::dmat3(scene.lights[0].world_from_light), glm::dmat3(1.0));
  EXPECT_NEAR(glm::distance(glm::dvec3(scene.lights[0].world_from_light[3]), glm::dvec3(1, 2, 3)), 0, 1e-12);
}

TEST(LightRoll, AxesWithinRoundingStay) {
  const glm::dmat4 level = lit(LightType::directional, {1, 2, 3}, 1).lights[0].world_from_light;
  Scene scene;
  scene.lights.push_back(analytic::light(LightType::directional, {1, 2, 3}));
  scene.lights[0].world_from_light = glm::rotate(level, 1e-8, glm::dvec3(0, 0, 1));
  const glm::dmat4 before = scene.lights[0].world_from_light;
  level_lights(scene);
  EXPECT_EQ(scene.lights[0].world_from_light, before);
}

TEST(LightRoll, SpotAndMovingLightsStay) {
  for (const bool moving : {false, true}) {
    Scene scene;
    scene.lights.push_back(analytic::light(moving ? LightType::directional : LightType::spot, {1, 2, 3}));
    scene.lights[0].moving = moving;
    scene.lights[0].world_from_light =
        glm::rotate(scene.lights[0].world_from_light, 1.0, glm::dvec3(0, 0, 1));
    const glm::dmat4 before = scene.lights[0].world_from_light;
    level_lights(scene);
    EXPECT_EQ(scene.lights[0].world_from_light, before);
  }
}

}  // namespace
}  // namespace gnomon
