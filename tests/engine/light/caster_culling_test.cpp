// Casters that a view needs, against rays from what it sees to the light.
#include "engine/light/caster_culling.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/light/light_view.h"
#include "engine/light/scene_facts.h"
#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

// A unit box, so that bounds are the body itself.
Mesh box() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back((i & 1) != 0 ? 0.5f : -0.5f, (i & 2) != 0 ? 0.5f : -0.5f,
                                (i & 4) != 0 ? 0.5f : -0.5f);
  mesh.normals.assign(8, {0, 1, 0});
  mesh.uvs.assign(8, {0, 0});
  mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  analytic::finish(mesh);
  return mesh;
}

Scene random_scene(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-10, 10);
  Scene scene;
  analytic::add(scene, analytic::square(12), {0, 0, 0});
  for (int i = 0; i < 40; ++i)
    analytic::add(scene, box(), {place(random), 0.5 + 0.2 * (i % 10), place(random)});
  scene.cameras.push_back(analytic::camera({place(random), 1 + std::abs(place(random)), place(random)},
                                           {place(random), 0, place(random)}));
  scene.cameras[0].fov_y = 0.5;
  const auto type = std::array{LightType::spot, LightType::directional, LightType::point}[random() % 3];
  scene.lights.push_back(analytic::light(type, {place(random), 6 + std::abs(place(random)), place(random)}));
  return scene;
}

// Does the segment from `a` to `b` meet the box around `centre`? Slabs.
bool meets(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& centre) {
  double from = 0, to = 1;
  for (int k = 0; k < 3; ++k) {
    const double d = b[k] - a[k], lo = (centre[k] - 0.5 - a[k]) / d, hi = (centre[k] + 0.5 - a[k]) / d;
    from = std::max(from, std::min(lo, hi)), to = std::min(to, std::max(lo, hi));
  }
  return from <= to;
}

std::vector<std::vector<bool>> needed_of(const Scene& scene, std::optional<uint32_t> reach) {
  return casters_in_view(scene, scene.cameras[0], 1.5, light_views(scene, 256, 1), 256, reach, {""});
}

TEST(CasterCulling, NoCasterOfAVisibleShadowIsLeftOut) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  size_t culled = 0, all = 0, shadows = 0;
  for (int round = 0; round < 60; ++round) {
    const Scene scene = random_scene(random);
    const auto needed = needed_of(scene, 1);
    const Camera& camera = scene.cameras[0];
    const Light& light = scene.lights[0];
    const glm::dvec3 eye(camera.world_from_camera[3]), lamp(light.world_from_light[3]);
    const double y = std::tan(0.5 * camera.fov_y);
    for (int ray = 0; ray < 400; ++ray) {  // points of the floor that the camera sees
      const glm::dvec3 way(camera.world_from_camera *
                           glm::dvec4(1.5 * y * unit(random), y * unit(random), -1, 0));
      if (way.y >= 0) continue;
      const glm::dvec3 p = eye - way * (eye.y / way.y);
      if (std::max(std::abs(p.x), std::abs(p.z)) > 12) continue;
      const glm::dvec3 towards =
          light.type == LightType::directional ? p + 100.0 * glm::dvec3(light.world_from_light[2]) : lamp;
      for (size_t i = 1; i < scene.instances.size(); ++i) {
        if (!meets(p, towards, glm::dvec3(scene.instances[i].world_from_object[3]))) continue;
        ++shadows;
        // A spot's map holds only what its frustum does.
        bool drawn = light.type == LightType::spot;
        for (const auto& view : needed) drawn = drawn || view[i];
        EXPECT_TRUE(drawn) << "round " << round << " instance " << i;
      }
    }
    for (const auto& view : needed)
      for (const bool one : view) ++all, culled += one ? 0 : 1;
  }
  EXPECT_GT(shadows, 1000u);
  EXPECT_GT(culled, all / 4) << "nothing much is left out";
}

TEST(CasterCulling, AllWhenReadersReadAnywhere) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    Scene scene = random_scene(random);
    scene.lights[0].type = LightType::directional;  // its view holds all of the scene
    const auto needed = needed_of(scene, std::nullopt);
    for (const bool one : needed[0]) EXPECT_TRUE(one);
  }
}

// A caster just outside of what the camera sees counts when readers reach as far.
TEST(CasterCulling, ReachTakesMoreCastersIn) {
  std::mt19937 random(5);
  size_t few = 0, many = 0;
  for (int round = 0; round < 20; ++round) {
    const Scene scene = random_scene(random);
    const auto near = needed_of(scene, 0), far = needed_of(scene, 40);
    for (size_t view = 0; view < near.size(); ++view)
      for (size_t i = 0; i < near[view].size(); ++i) {
        EXPECT_TRUE(!near[view][i] || far[view][i]);
        few += near[view][i], many += far[view][i];
      }
  }
  EXPECT_LT(few, many);
}

TEST(CasterCulling, NothingWhereTheCameraSeesNothing) {
  Scene scene = analytic::square_over_plane(analytic::light(LightType::directional, {1, 5, 1}));
  scene.cameras[0] = analytic::camera({0, 5, 0}, {0, 50, 1});
  const auto needed = needed_of(scene, 4);
  for (const bool one : needed[0]) EXPECT_FALSE(one);
}

std::string why(const Scene& scene) { return scene_facts(scene, scene.cameras[0], 1.5, 480).shadowless[0]; }

TEST(SceneFacts, WhyALightThrowsNoVisibleShadow) {
  Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {1, 6, 1}));
  EXPECT_EQ(why(scene), "");
  Scene far = scene;
  far.lights[0].range = 1;
  EXPECT_NE(why(far).find("range"), std::string::npos);
  Scene aside = scene;
  aside.lights[0].world_from_light = analytic::frame({1, 6, 1}, {1, 60, 1}, {0, 0, 1});
  EXPECT_NE(why(aside).find("frustum"), std::string::npos);
  Scene alone = scene;
  alone.instances.resize(1);
  EXPECT_EQ(why(alone), SceneFacts::no_caster);
  Scene blind = scene;
  blind.cameras[0] = analytic::camera({0, 5, 0}, {0, 50, 1});
  EXPECT_NE(why(blind).find("sees nothing"), std::string::npos);
  EXPECT_EQ(promising_nothing(scene_facts(alone, alone.cameras[0], 1.5)).shadowless[0], "");
}

TEST(SceneFacts, WidthOfThePenumbraInPixels) {
  Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {0, 6, 0}));
  const auto facts = [&] { return scene_facts(scene, scene.cameras[0], 1.5, 480); };
  EXPECT_EQ(facts().penumbra[0], 0);
  EXPECT_TRUE(facts().shines_as_point(0));
  scene.lights[0].area = AreaLight{AreaLight::Shape::rectangle, 1, 1, {}, {}};
  EXPECT_FALSE(facts().shines_as_point(0));
  const double wide = facts().penumbra[0];
  scene.lights[0].area->width = scene.lights[0].area->height = 1e-9;
  EXPECT_TRUE(facts().shines_as_point(0));
  EXPECT_NEAR(facts().penumbra[0] / wide, 1e-9, 3e-10);  // the gap to the caster counts the light's own size
  EXPECT_EQ(scene_facts(scene, scene.cameras[0], 1.5).shines_as_point(0), false) << "no pixel is known";
}

}  // namespace
}  // namespace gnomon
