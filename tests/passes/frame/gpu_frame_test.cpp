// The passes that every frame has: the G-buffer with each kind of draw, and shading by more lights than come
// as flat inputs.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "bench/error/measure.h"
#include "bench/error/truth.h"
#include "engine/light/ambient.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using namespace analytic;

// A draw of each kind: of one colour, textured, with vertex colours, alpha-masked, double-sided, mirrored and
// turned.
Scene scene_of_all_draws() {
  Scene scene;
  Texture checks{"checks", 2, 2, {255, 0, 0, 255, 0, 255, 0, 40, 90, 90, 255, 60, 200, 200, 10, 255}};
  scene.textures.push_back(checks);
  Material plain, textured, masked, both_sided;
  plain.base_color = {0.3f, 0.6f, 0.1f, 1.0f};
  textured.base_color_texture = 0;
  masked = textured;
  masked.alpha_masked = masked.double_sided = true;
  both_sided.double_sided = true;
  Mesh coloured = sphere(0.8f, 8, 12);
  for (size_t i = 0; i < coloured.positions.size(); ++i)
    coloured.colors.emplace_back(0.1f * float(i % 10), 0.5f, 1, 1);
  add(scene, square(6), {0, 0, 0}, plain);
  add(scene, square(1.2f), {-2, 0.7, 0}, textured);
  add(scene, coloured, {1.5, 1, 1}, Material{});
  add(scene, square(1), {0, 1.5, -1}, masked);
  add(scene, square(0.8f, false), {2, 2, -1}, both_sided);
  add(scene, sphere(0.7f, 8, 12), {-1, 1, 2}, plain);
  Instance& mirrored = scene.instances.back();
  mirrored.world_from_object = glm::rotate(mirrored.world_from_object, 0.7, glm::dvec3(1, 2, 3));
  mirrored.world_from_object = glm::scale(mirrored.world_from_object, glm::dvec3(-1, 1.4, 0.8));
  scene.cameras.push_back(camera({3, 4, 6}, {0, 0.8, 0}));
  scene.lights.push_back(light(LightType::spot, {2, 7, 1}));
  return scene;
}

// With everything kept all draws test their coverage.
TEST(GBuffer, DrawsWithoutAMaskHaveTheSameBits) {
  const auto scene = std::make_shared<const Scene>(scene_of_all_draws());
  for (const bool reversed_z : {true, false})
    for (const char* port : {"gbuffer.depth", "gbuffer.normal", "gbuffer.geometric", "gbuffer.albedo"}) {
      SCOPED_TRACE(port);
      RenderSettings s = hard_shadow::settings(reversed_z);
      s.captures = {port};
      Image images[2];
      for (const bool keep_all : {false, true}) {
        s.keep_all = keep_all;
        Renderer renderer(hard_shadow::device(), scene, load_graph(find_graph("shadow_mapping")), s);
        renderer.render(TimingMode::none);
        images[keep_all] = renderer.read(port);
      }
      EXPECT_EQ(images[0].data, images[1].data);
      for (const float value : images[0].data) ASSERT_TRUE(std::isfinite(value));
    }
}

// Five lights, three of which are flat inputs.
TEST(Compose, EveryLightShines) {
  Scene scene;
  Material grey;
  grey.base_color = {0.5f, 0.25f, 0.75f, 1.0f};
  add(scene, square(3), {0, 0, 0}, grey);
  scene.cameras.push_back(camera({2, 5, 4}, {0, 0, 0}));
  scene.lights.push_back(light(LightType::spot, {2, 4, 0}));
  scene.lights.push_back(light(LightType::directional, {1, 2, 3}));
  scene.lights.push_back(light(LightType::point, {-2, 2, 1}));
  scene.lights.push_back(light(LightType::spot, {-1, 3, -2}, {0.5, 0, 0}));
  scene.lights.push_back(light(LightType::point, {2, 1, 2}));
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    scene.lights[i].intensity = 3 + double(i);
    scene.lights[i].color = {1.0, 0.2 * double(i), 0.5};
  }
  scene.lights[4].range = 3;
  scene.lights[3].inner_cone = 0.3, scene.lights[3].outer_cone = 0.6;
  for (const bool reversed_z : {true, false}) {
    const RenderSettings s = hard_shadow::settings(reversed_z, 64, 48);
    Renderer renderer(hard_shadow::device(), std::make_shared<Scene>(scene),
                      load_graph(find_graph("shadow_mapping")), s);
    renderer.render(TimingMode::none);
    const Image shown = renderer.read("color"), visibility = renderer.read("visibility");
    const Reference reference = hard_shadow::trace(scene, s);
    const Image expected = shade_reference(scene, scene.cameras[0], reference);
    int background = 0;
    for (size_t i = 0; i < reference.depth.size(); ++i) {
      const bool empty = std::isinf(reference.depth[i]);
      background += empty;
      for (size_t c = 0; c < 3; ++c) {
        const double right = expected.plane(c)[i];
        EXPECT_NEAR(shown.plane(c)[i], right, empty ? 0 : 0.01 * right + 1e-4) << i << ' ' << c;
      }
      for (size_t l = 0; empty && l < scene.lights.size(); ++l) EXPECT_EQ(visibility.plane(l)[i], 1.0f);
    }
    EXPECT_GT(background, 100);
    EXPECT_LT(background, 2000);
  }
}

// A square under a sky, and another one that hides it from the light.
TEST(Compose, TheSkyShinesWhereNoLightDoes) {
  Scene scene = square_over_plane(light(LightType::spot, {1.5, 7, 1}));
  scene.lights[0].intensity = 30;
  const RenderSettings s = hard_shadow::settings(true, 64, 48);
  const Graph graph = load_graph(find_graph("shadow_volumes"), {{"ambient", 0.25}});
  Renderer renderer(hard_shadow::device(), std::make_shared<Scene>(scene), graph, s);
  renderer.render(TimingMode::none);
  const Image shown = renderer.read("color"), visibility = renderer.read("visibility");
  EXPECT_EQ(visibility.data, hard_shadow::visibility("shadow_volumes", scene, s)[0]);
  const Ambient ambient = ambient_of(graph);
  EXPECT_EQ(ambient.share, 0.25);
  const glm::dvec3 sky = sky_radiance(scene, ambient);
  const Reference reference = hard_shadow::trace(scene, s);
  const Image expected = shade_reference(scene, scene.cameras[0], reference, ambient);
  int dark = 0;
  for (size_t i = 0; i < reference.depth.size(); ++i)
    for (size_t c = 0; c < 3; ++c) {
      const double value = shown.plane(c)[i];
      if (visibility.plane(0)[i] != reference.visibility[0][i]) continue;
      EXPECT_NEAR(value, expected.plane(c)[i], 0.01 * value + 1e-4) << i << ' ' << c;
      EXPECT_GT(value, 0);
      if (visibility.plane(0)[i] != 0) continue;
      ++dark;  // white, and upright below the sky: its radiance
      EXPECT_NEAR(value, sky[int(c)], 0.01 * value);
    }
  EXPECT_GT(dark, 100);
  EXPECT_EQ(ambient_of(load_graph(find_graph("shadow_volumes"))), Ambient{});
}

}  // namespace
}  // namespace gnomon
