// Counts of a scene's geometry.
#include "engine/scene/scene_sizes.h"

#include <gtest/gtest.h>

#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

TEST(SceneSizes, CountsInstancesOfOpenAndClosedMeshes) {
  Scene scene;
  analytic::add(scene, analytic::square(1), {0, 0, 0});        // 2 triangles
  analytic::add(scene, analytic::sphere(1, 4, 8), {0, 2, 0});  // 2 rows of 8, 2 of 16
  analytic::add(scene, analytic::sphere(1, 4, 8), {3, 2, 0});
  scene.instances.push_back(scene.instances[1]);
  const SceneSizes sizes = scene_sizes(scene);
  EXPECT_EQ(sizes.instances, 4u);
  EXPECT_EQ(sizes.vertices, 4 + 3 * 5 * 8u);
  EXPECT_EQ(sizes.triangles, 2 + 3 * 48u);
  EXPECT_EQ(sizes.edges, 3 * sizes.triangles);
  EXPECT_EQ(sizes.sides, 3 * sizes.triangles);
}

TEST(SceneSizes, WithoutASceneTheyAreThoseOfATriangle) {
  EXPECT_EQ(scene_sizes(Scene{}), (SceneSizes{0, 1, 1, 1, 1}));  // nothing of size 0
  Scene scene;
  Mesh triangle = analytic::square(1);
  triangle.indices.resize(3);
  triangle.positions.resize(3);
  analytic::add(scene, triangle, {0, 0, 0});
  EXPECT_EQ(scene_sizes(scene), SceneSizes{});
}

}  // namespace
}  // namespace gnomon
