// Which meshes are solids, and of which solids the camera sees nothing within.
#include "passes/volume/closed_casters.h"

#include <gtest/gtest.h>

#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

using analytic::cube;

// Both in one mesh, the second one moved.
Mesh joined(Mesh a, const Mesh& b, const glm::vec3& by = glm::vec3(0)) {
  const auto first = static_cast<uint32_t>(a.positions.size());
  for (const glm::vec3& p : b.positions) a.positions.push_back(p + by);
  for (const uint32_t i : b.indices) a.indices.push_back(first + i);
  analytic::finish(a);
  return a;
}

TEST(ClosedCasters, SolidsFaceOutwards) {
  EXPECT_TRUE(is_solid(cube(1)));
  EXPECT_TRUE(is_solid(analytic::sphere(1, 8, 16)));
  EXPECT_FALSE(is_solid(cube(1, false)));
  EXPECT_FALSE(is_solid(analytic::square(1)));
}

TEST(ClosedCasters, EveryShellCounts) {
  EXPECT_TRUE(is_solid(joined(cube(1), cube(1), {5, 0, 0})));
  EXPECT_FALSE(is_solid(joined(cube(2), cube(1, false), {5, 0, 0})));  // a room beside
  EXPECT_TRUE(is_solid(joined(cube(2), cube(1, false))));              // a hollow
  EXPECT_TRUE(is_solid(joined(joined(cube(3), cube(2, false)), cube(1))));
}

TEST(ClosedCasters, FarFromTheirOrigin) {
  Mesh mesh = cube(0.5f);
  for (glm::vec3& p : mesh.positions) p += glm::vec3(4096, -8192, 2048);
  analytic::finish(mesh);
  EXPECT_TRUE(is_solid(mesh));
}

TEST(ClosedCasters, TheCameraIsInsideOrAtTheSurface) {
  Scene scene;
  Material two_sided;
  two_sided.double_sided = true;
  analytic::add(scene, cube(2), {0, 0, 0});
  analytic::add(scene, cube(1), {8, 0, 0});
  analytic::add(scene, cube(1), {8, 4, 0}, two_sided);
  analytic::add(scene, cube(1, false), {8, 8, 0});
  const std::vector<bool> solid = solid_meshes(scene);
  EXPECT_EQ(solid, (std::vector<bool>{true, true, false, false}));
  const auto unseen = [&](const glm::dvec3& eye) {
    return unseen_inside(scene, solid, analytic::camera(eye, eye + glm::dvec3(1, 0, 0)), 1.5);
  };
  EXPECT_EQ(unseen({0, 6, 0}), (std::vector<bool>{true, true, false, false}));
  EXPECT_EQ(unseen({0, 0, 0}), (std::vector<bool>{false, true, false, false}));
  EXPECT_EQ(unseen({-2.05, 0, 0}), (std::vector<bool>{false, true, false, false}));  // near is 0.1
  EXPECT_EQ(unseen({-2.2, 0, 0}), (std::vector<bool>{true, true, false, false}));
  EXPECT_EQ(unseen({8.5, 0.5, 0}), (std::vector<bool>{true, false, false, false}));
}

}  // namespace
}  // namespace gnomon
