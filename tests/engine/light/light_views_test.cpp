// Projections of a light's views: what they hold, and their near and far planes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/base/error.h"
#include "engine/light/light_view.h"
#include "engine/light/scene_facts.h"
#include "engine/scene/scene.h"

namespace gnomon {
namespace {

constexpr double pi = std::numbers::pi;

Mesh quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
  Mesh mesh;
  mesh.name = "quad";
  mesh.positions = {a, b, c, d};
  mesh.normals.assign(4, glm::vec3(0, 1, 0));
  mesh.uvs.assign(4, glm::vec2(0));
  mesh.indices = {0, 1, 2, 0, 2, 3};
  for (const glm::vec3& p : mesh.positions) mesh.bounds.add(glm::dvec3(p));
  return mesh;
}

Mesh floor_at(float y, float half) {
  return quad({-half, y, half}, {half, y, half}, {half, y, -half}, {-half, y, -half});
}

Scene scene_of(std::vector<Mesh> meshes, Light light) {
  Scene scene;
  scene.materials.resize(1);
  for (uint32_t i = 0; i < meshes.size(); ++i) {
    scene.instances.push_back({"", i, glm::dmat4(1.0)});
    scene.bounds.add(meshes[i].bounds.min);
    scene.bounds.add(meshes[i].bounds.max);
  }
  scene.meshes = std::move(meshes);
  scene.cameras.resize(1);
  scene.lights = {std::move(light)};
  return scene;
}

// Looks straight down from `height`; local x is the world's x, local y the world's -z.
Light down(LightType type, double height) {
  Light light;
  light.type = type;
  light.world_from_light = glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, -1, 0), glm::dvec4(0, 1, 0, 0),
                                      glm::dvec4(0, height, 0, 1));
  return light;
}

glm::dvec3 ndc(const LightView& view, const glm::dvec3& light_space) {
  const glm::dvec4 clip = view.clip_from_light() * glm::dvec4(light_space, 1.0);
  return glm::dvec3(clip) / clip.w;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

TEST(LightViews, PerspectiveCornersMapToClipCorners) {
  Light light = down(LightType::spot, 10);
  light.map_fov = pi / 3;
  const LightView view = light_views(scene_of({floor_at(0, 4), floor_at(3, 1)}, light), 512, 4)[0];
  const double t = std::tan(pi / 6);
  EXPECT_DOUBLE_EQ(view.half_width, t);
  EXPECT_NEAR(view.near, 7 * 0.99, 1e-12);
  EXPECT_NEAR(view.far, 10 * 1.01, 1e-12);
  expect_near(ndc(view, {t * view.near, t * view.near, -view.near}),
              {1, -1, 0});  // up in light space is -y in clip
  expect_near(ndc(view, {-t * view.far, -t * view.far, -view.far}), {-1, 1, 1});
  const double d = 8;  // in between: far (d - near) / (d (far - near))
  expect_near(ndc(view, {0, 0, -d}), {0, 0, view.far * (d - view.near) / (d * (view.far - view.near))});
}

// Both triangles of the floor have every vertex outside the frustum; what the frustum holds of them counts.
TEST(LightViews, LargeTrianglesAreFittedByTheirPartInside) {
  Light light = down(LightType::spot, 10);
  light.map_fov = pi / 2;
  Mesh slope = quad({-100, -100, 100}, {100, 100, 100}, {100, 100, -100}, {-100, -100, -100});  // y = x
  const LightView view = light_views(scene_of({slope}, light), 512, 4)[0];
  // Inside |x| <= 10 - y: the plane y = x reaches from x = 5 (depth 5) down to where -x = 10 - x has no
  // solution but the mesh's edge at x = -100 (depth 110).
  EXPECT_NEAR(view.near, 5 * 0.99, 1e-9);
  EXPECT_NEAR(view.far, 110 * 1.01, 1e-9);
}

TEST(LightViews, OrthographicIsFittedToVertices) {
  const Scene scene = scene_of({floor_at(0, 4), floor_at(3, 1)}, down(LightType::directional, -50));
  const std::vector<LightView> views = light_views(scene, 512, 4);
  ASSERT_EQ(views.size(), 1u);
  const LightView& view = views[0];
  EXPECT_TRUE(view.orthographic);
  EXPECT_NEAR(view.half_width, 4 * 1.01, 1e-12);
  EXPECT_NEAR(view.half_height, 4 * 1.01, 1e-12);
  EXPECT_GT(view.near, 0);
  expect_near(ndc(view, {view.half_width, view.half_height, -view.near}), {1, -1, 0});
  expect_near(ndc(view, {-view.half_width, -view.half_height, -view.far}), {-1, 1, 1});
  for (const Mesh& mesh : scene.meshes) {
    for (const glm::vec3& p : mesh.positions) {
      const glm::dvec3 q = ndc(view, glm::dvec3(view.light_from_world * glm::dvec4(glm::dvec3(p), 1.0)));
      EXPECT_LT(std::max(std::abs(q.x), std::abs(q.y)), 1.0);
      EXPECT_GT(q.z, 0.0);
      EXPECT_LT(q.z, 1.0);
    }
  }
  // Depth grows away from the light.
  const auto depth = [&](double y) {
    return ndc(view, glm::dvec3(view.light_from_world * glm::dvec4(0, y, 0, 1))).z;
  };
  EXPECT_LT(depth(3), depth(0));
}

TEST(LightViews, OrthographicFitUsesVerticesNotBoxes) {
  // A thin diagonal quad: its box, turned into light axes, would be larger.
  Mesh diagonal = quad({-1, 0, 1}, {1, 0, -1}, {1, 0.1f, -1}, {-1, 0.1f, 1});
  Light light = down(LightType::directional, 5);
  const double c = std::sqrt(0.5);
  light.world_from_light[0] = glm::dvec4(c, 0, c, 0);
  light.world_from_light[1] = glm::dvec4(c, 0, -c, 0);
  const LightView view = light_views(scene_of({diagonal}, light), 512, 0)[0];
  EXPECT_NEAR(view.half_height, std::sqrt(2.0) * 1.01, 1e-6);
  EXPECT_LT(view.half_width, 0.01);
  EXPECT_GT(view.half_width, 0.0);
}

TEST(LightViews, PointFacesCoverAllDirectionsWithTheirBorder) {
  Light light = down(LightType::point, 2);
  const uint32_t size = 256, border = 8;
  const std::vector<LightView> views =
      light_views(scene_of({floor_at(-3, 5), floor_at(6, 5)}, light), size, border);
  ASSERT_EQ(views.size(), 6u);
  const glm::dvec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(views[i].half_width, 256.0 / 240.0, 1e-15);
    EXPECT_EQ(views[i].near, views[0].near);
    EXPECT_EQ(views[i].far, views[0].far);
    EXPECT_NEAR(glm::determinant(glm::dmat3(views[i].light_from_world)), 1.0, 1e-12);
    const glm::dvec4 axis = light.world_from_light * glm::dvec4(axes[i], 0.0);
    expect_near(glm::dvec3(views[i].light_from_world * axis), {0, 0, -1});
  }
  // A direction at 45 degrees is `border` texels from the map's edge: (1 - ndc) / 2 * size = border.
  expect_near(ndc(views[0], {1, 1, -1}), {240.0 / 256, -240.0 / 256, ndc(views[0], {0, 0, -1}).z});
  // Every direction is inside exactly one view's 90 degrees.
  for (int k = 0; k < 500; ++k) {
    const double z = -1 + 2 * (k + 0.5) / 500, a = 2.399963 * k, r = std::sqrt(1 - z * z);
    int holders = 0;
    for (const LightView& view : views) {
      const glm::dvec3 d(view.light_from_world * glm::dvec4(r * std::cos(a), r * std::sin(a), z, 0.0));
      holders += -d.z > std::max(std::abs(d.x), std::abs(d.y));
    }
    EXPECT_EQ(holders, 1);
  }
}

// Nearest surface straight below at 4 along the view's axis, farthest vertex 5 (max norm).
TEST(LightViews, PointRangeIsCommonAndUsesDepthAlongTheAxis) {
  const std::vector<LightView> views =
      light_views(scene_of({floor_at(0, 5)}, down(LightType::point, 4)), 256, 0);
  EXPECT_NEAR(views[0].near, 4 * 0.99, 1e-9);
  EXPECT_NEAR(views[0].far, 5 * 1.01, 1e-9);
}

TEST(LightViews, BorderThatLeavesNothingIsAnError) {
  const Scene scene = scene_of({floor_at(0, 5)}, down(LightType::point, 4));
  EXPECT_THROW(light_views(scene, 16, 8), Error);
  EXPECT_EQ(light_views(scene, 17, 8).size(), 6u);
}

TEST(LightViews, RangesAreValidWhateverTheLightSees) {
  for (const double height : {-5.0, 0.0, 1e-7, 2.0, 1e6}) {
    for (const LightType type : {LightType::spot, LightType::point, LightType::directional}) {
      for (const LightView& view :
           light_views(scene_of({floor_at(0, 4), floor_at(3, 1)}, down(type, height)), 128, 4)) {
        EXPECT_GT(view.near, 0.0) << height;
        EXPECT_GE(view.near, 0.99e-6 * view.far);
        EXPECT_GT(view.far, view.near) << height;
        EXPECT_TRUE(std::isfinite(view.far));
        EXPECT_GT(view.half_width, 0.0);
        EXPECT_GT(view.half_height, 0.0);
      }
    }
  }
}

TEST(LightViews, FarOriginGivesTheSameFit) {
  for (const LightType type : {LightType::spot, LightType::point, LightType::directional}) {
    Scene scene = scene_of({floor_at(0, 4), floor_at(3, 1)}, down(type, 10));
    const std::vector<LightView> here = light_views(scene, 128, 4);
    const glm::dvec4 offset(6.4e6, -3e6, 1e6, 0);
    for (Instance& instance : scene.instances) instance.world_from_object[3] += offset;
    scene.lights[0].world_from_light[3] += offset;
    scene.bounds.min += glm::dvec3(offset);
    scene.bounds.max += glm::dvec3(offset);
    const std::vector<LightView> there = light_views(scene, 128, 4);
    for (size_t i = 0; i < here.size(); ++i) {
      EXPECT_NEAR(here[i].near, there[i].near, 1e-7);
      EXPECT_NEAR(here[i].far, there[i].far, 1e-7);
      EXPECT_NEAR(here[i].half_width, there[i].half_width, 1e-7);
    }
  }
}

Camera camera_at(const glm::dvec3& eye) {  // looks along -z
  Camera camera;
  camera.world_from_camera[3] = glm::dvec4(eye, 1.0);
  return camera;
}

TEST(SceneFacts, ALonePlaneShadowsNothing) {
  const Scene scene = scene_of({floor_at(0, 5)}, down(LightType::spot, 10));
  EXPECT_NE(scene_facts(scene, camera_at({0, 1, 8}), 1.0).shadowless[0], "");
}

TEST(SceneFacts, APlaneAboveAnotherShadowsIt) {
  for (const LightType type : {LightType::spot, LightType::point, LightType::directional}) {
    const Scene scene = scene_of({floor_at(0, 5), floor_at(2, 1)}, down(type, 10));
    EXPECT_EQ(scene_facts(scene, camera_at({0, 1, 8}), 1.0).shadowless[0], "");
  }
}

TEST(SceneFacts, AShadowBehindTheCameraIsNotVisible) {
  Mesh near = quad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}), far = near, blocker = near;
  for (glm::vec3& p : far.positions) p.z += 30;
  for (glm::vec3& p : blocker.positions) p.z += 30, p.y += 2;
  for (Mesh* mesh : {&far, &blocker}) {
    mesh->bounds = {};
    for (const glm::vec3& p : mesh->positions) mesh->bounds.add(glm::dvec3(p));
  }
  const Scene scene = scene_of({near, far, blocker}, down(LightType::directional, 10));
  EXPECT_NE(scene_facts(scene, camera_at({0, 1, 8}), 1.0).shadowless[0], "");
  EXPECT_EQ(scene_facts(scene, camera_at({0, 1, 40}), 1.0).shadowless[0], "");
}

TEST(SceneFacts, AnObjectBelowAPlaneDoesNotShadowIt) {
  const Scene scene = scene_of({floor_at(0, 5), floor_at(-2, 1)}, down(LightType::spot, 10));
  // Seen from above, both are in view, and the floor shadows the lower one.
  EXPECT_EQ(scene_facts(scene, camera_at({0, 1, 20}), 1.0).shadowless[0], "");
}

}  // namespace
}  // namespace gnomon
