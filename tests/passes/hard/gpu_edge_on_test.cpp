// Rounding does not decide whether a wall faces the sun above it, and a sun's turn about its own axis shows
// nowhere.
#include <gtest/gtest.h>

#include <numbers>
#include <optional>

#include "engine/scene/light_roll.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using namespace analytic;

class EdgeOnSurfaces : public testing::TestWithParam<const char*> {};

TEST_P(EdgeOnSurfaces, AreInShadowHoweverTheSunIsTurned) {
  std::optional<std::vector<std::vector<float>>> first;
  for (int roll = 0; roll < 12; ++roll) {
    Scene scene;
    add(scene, square(5), {0, 0, 0});
    add(scene, cube(0.5f), {0, 1.5, 0});
    scene.cameras.push_back(camera({3, 4, 6}, {0, 0, 0}));
    scene.lights.push_back(light(LightType::directional, {0, 5, 0}));
    const double angle = roll * std::numbers::pi / 6 + 0.1;
    scene.lights[0].world_from_light =
        scene.lights[0].world_from_light * glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(0, 0, 1));
    // As a rotation that is stored in floats, or not quite exact, leaves it.
    scene.lights[0].world_from_light[2] += glm::dvec4(roll % 3 - 1, 0, roll % 2, 0) * 1e-7;
    level_lights(scene);
    const auto visibility = hard_shadow::visibility(GetParam(), scene, hard_shadow::settings(true));
    if (!first) first = visibility;
    EXPECT_EQ(visibility, *first) << roll;
  }
}

INSTANTIATE_TEST_SUITE_P(Graphs, EdgeOnSurfaces,
                         testing::Values("shadow_mapping", "shadow_volumes", "planar_shadows"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace gnomon
