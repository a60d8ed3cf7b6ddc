// Scenes that reach further than floats can be calculated with are refused, with the place.
#include "engine/scene/scene_limits.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "engine/base/error.h"
#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

Scene plain_scene() {
  Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {0, 6, 0}));
  scene.instances[1].name = "roof";
  scene.cameras[0].name = "eye";
  scene.lights[0].name = "lamp";
  return scene;
}

void expect_refused(const Scene& scene, const std::string& place) {
  try {
    check_limits(scene);
    ADD_FAILURE() << place;
  } catch (const Error& error) {
    ASSERT_EQ(error.problems().size(), 1u);
    EXPECT_EQ(error.problems()[0].place, place);
  }
}

TEST(SceneLimits, WhatCanBeTracedIsTaken) {
  EXPECT_NO_THROW(check_limits(plain_scene()));
  Scene scene = plain_scene();
  scene.instances[1].world_from_object = glm::scale(glm::dmat4(1.0), glm::dvec3(1e14));
  scene.lights[0].world_from_light[3] = {1e15, -1e15, 0, 1};
  EXPECT_NO_THROW(check_limits(scene));
}

TEST(SceneLimits, WhatCannotIsRefusedWithItsPlace) {
  Scene scene = plain_scene();
  scene.instances[1].world_from_object = glm::scale(glm::dmat4(1.0), glm::dvec3(1e20));
  expect_refused(scene, "node 'roof'");
  scene = plain_scene();
  scene.cameras[0].world_from_camera[3].x = std::numeric_limits<double>::infinity();
  expect_refused(scene, "camera 'eye'");
  scene = plain_scene();
  scene.cameras[0].aspect = 1e30;
  expect_refused(scene, "camera 'eye'");
  scene = plain_scene();
  scene.lights[0].world_from_light[3].y = std::nan("");
  expect_refused(scene, "light 'lamp'");
  scene = plain_scene();
  scene.lights[0].area = AreaLight{AreaLight::Shape::rectangle, 1e19, 1, {}, {}};
  expect_refused(scene, "light 'lamp'");
}

}  // namespace
}  // namespace gnomon
