// Moving scenes on the device: what counts as changed, where things were, and frames against the ray tracer.
#include <gtest/gtest.h>

#include "engine/render/gpu_scene.h"
#include "engine/scene/animation.h"
#include "tests/engine/scene/moving_scenes.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using analytic::Mover;

// A square at height 2 above a plane and a small one at height 3, nearer to the light than the other ever is.
Scene two_squares(LightType type = LightType::spot) {
  Scene scene = analytic::square_over_plane(analytic::light(type, {0.5, 7, 0.5}));
  analytic::add(scene, analytic::square(0.3f), {0.5, 3, 0.5});
  return scene;
}

class GpuAnimation : public testing::Test {
 protected:
  static std::shared_ptr<Device> device() { return test::kernel_device(); }
  static GpuScene on_device(const Mover& mover) {
    return GpuScene(device(), std::make_shared<const Scene>(mover.scene));
  }
  static constexpr FrameView view{0, 64, 48, true};
};

TEST_F(GpuAnimation, StillFramesChangeNothing) {
  GpuScene scene(device(), std::make_shared<const Scene>(two_squares()));
  scene.update(view, 0, 0);
  EXPECT_TRUE(scene.casters_changed());
  EXPECT_TRUE(scene.light_changed(0));
  EXPECT_TRUE(scene.camera_changed());
  scene.update(view, 5, 1);  // nothing moves, whatever the time
  EXPECT_FALSE(scene.casters_changed());
  EXPECT_FALSE(scene.light_changed(0));
  EXPECT_FALSE(scene.camera_changed());
  EXPECT_EQ(scene.frame().previous_clip_from_relative, scene.frame().clip_from_relative);
  scene.update({0, 32, 48, true}, 5, 2);
  EXPECT_TRUE(scene.camera_changed());
  scene.update({0, 32, 48, true}, 5, 0);  // a new sequence
  EXPECT_TRUE(scene.casters_changed());
}

TEST_F(GpuAnimation, EachMovementIsToldApart) {
  GpuScene casters = on_device(Mover(two_squares()).instance(1, {0.2, 0, 0}));
  casters.update(view, 0, 0);
  casters.update(view, 0.5, 1);
  EXPECT_TRUE(casters.casters_changed());
  EXPECT_FALSE(casters.light_changed(0));
  EXPECT_FALSE(casters.camera_changed());
  EXPECT_EQ(casters.scene().instances[1].world_from_object[3].x, 0.1);
  casters.update(view, 0.5, 2);
  EXPECT_FALSE(casters.casters_changed());
  casters.update(view, 7, 3);  // clamped to the end
  casters.update(view, 8, 4);
  EXPECT_FALSE(casters.casters_changed());

  GpuScene light = on_device(Mover(two_squares()).light({1, 0, 0}));
  light.update(view, 0, 0);
  light.update(view, 0.25, 1);
  EXPECT_FALSE(light.casters_changed());
  EXPECT_TRUE(light.light_changed(0));
  EXPECT_FALSE(light.camera_changed());

  GpuScene camera = on_device(Mover(two_squares()).camera({1, 0, 0}));
  camera.update(view, 0, 0);
  camera.update(view, 0.25, 1);
  EXPECT_FALSE(camera.casters_changed());
  EXPECT_FALSE(camera.light_changed(0));
  EXPECT_TRUE(camera.camera_changed());
}

// The place of a still point in the previous image: by the previous frame's own matrix, and by this one's.
TEST_F(GpuAnimation, PreviousMatrixFindsThePlaceBefore) {
  for (const double offset : {0.0, 1e6}) {
    Mover mover(analytic::moved(two_squares(), {offset, 0, -offset}));
    mover.camera({1.5, -0.5, 0.7});
    GpuScene scene = on_device(mover);
    scene.update(view, 0.2, 0);
    const FrameData before = scene.frame();
    const glm::dvec3 eye_before(scene.scene().cameras[0].world_from_camera[3]);
    scene.update(view, 0.6, 1);
    const glm::dvec3 eye(scene.scene().cameras[0].world_from_camera[3]);
    ASSERT_GT(glm::length(eye - eye_before), 0.5);
    for (const glm::dvec3 p : {glm::dvec3(0, 0, 0), {1, 2, -1}, {-3, 0, 2}}) {
      const glm::dvec3 world = p + glm::dvec3(offset, 0, -offset);
      const glm::vec4 wanted = before.clip_from_relative * glm::vec4(glm::vec3(world - eye_before), 1);
      const glm::vec4 got = scene.frame().previous_clip_from_relative * glm::vec4(glm::vec3(world - eye), 1);
      for (int i = 0; i < 4; ++i) EXPECT_NEAR(got[i], wanted[i], 1e-5) << "at " << offset;
    }
  }
}

// A scale that changes its sign turns the winding over: the front stays outside.
TEST_F(GpuAnimation, InstancesThatTurnOverKeepTheirFront) {
  Scene scene;
  analytic::add(scene, analytic::square(20), {0, 0, 0});
  analytic::add(scene, analytic::sphere(1, 16, 32), {0, 1.5, 0});
  scene.cameras.push_back(analytic::camera({6, 8, 7}, {0, 0, 0}));
  scene.lights.push_back(analytic::light(LightType::spot, {1.5, 7, 1}));
  const auto animation = std::make_shared<Animation>();
  NodeTransform rest;
  rest.translation = {0, 1.5, 0};
  const Track flip{Interpolation::linear, {0, 1}, {glm::dvec4(1, 1, 1, 0), glm::dvec4(-1, 1, 1, 0)}};
  animation->nodes.push_back({{}, rest, {}, {}, flip, true});
  animation->instances.push_back({1, 0, glm::dmat4(1.0)});
  scene.instances[1].moving = true;
  scene.animation = animation;
  const RenderSettings s = hard_shadow::settings(true);
  for (const char* graph : {"shadow_mapping", "shadow_volumes"}) {
    Renderer renderer(device(), std::make_shared<const Scene>(scene), load_graph(find_graph(graph)), s);
    for (const double seconds : {0.0, 1.0, 0.25}) {
      renderer.seek(seconds);
      renderer.render(TimingMode::none);
      const Image image = renderer.read("visibility");
      const std::vector<float> shown(image.plane(0).begin(), image.plane(0).end());
      const auto error =
          hard_shadow::compare({{shown}, {}, {}}, hard_shadow::trace(posed(scene, seconds), s));
      EXPECT_LT(error.share(), 0.01) << graph << " at " << seconds;
      EXPECT_GT(error.shadowed, 50u);
    }
  }
}

// A renderer that has played to a time shows what one of the scene standing there shows, to the bit; and that
// is what the ray tracer sees.
TEST_F(GpuAnimation, PosesAreThoseOfTheReference) {
  for (const char* graph : {"shadow_mapping", "shadow_volumes"}) {
    for (const LightType type : {LightType::spot, LightType::point, LightType::directional}) {
      Mover mover(two_squares(type));
      mover.instance(1, {1.0, 0.5, -1.0}).light({-1, 0, 1}).camera({0.5, 0.5, 0});
      RenderSettings s = hard_shadow::settings(true);
      s.frame_seconds = 0.5;
      const auto graph_file = load_graph(find_graph(graph));
      const size_t messages = validation_messages(*device()).size();
      Renderer renderer(device(), std::make_shared<const Scene>(mover.scene), graph_file, s);
      renderer.render(TimingMode::none);
      renderer.play();
      std::vector<std::vector<float>> shown;
      for (const double seconds : {0.0, 0.5, 1.0}) {
        renderer.render(TimingMode::none);
        EXPECT_EQ(renderer.seconds(), seconds);
        const Image image = renderer.read("visibility");
        shown.emplace_back(image.plane(0).begin(), image.plane(0).end());
        Scene still = posed(mover.scene, seconds);
        still.animation = nullptr;
        EXPECT_EQ(shown.back(), hard_shadow::visibility(graph, still, s)[0]) << graph << " at " << seconds;
        const auto error = hard_shadow::compare({{shown.back()}, {}, {}}, hard_shadow::trace(still, s));
        EXPECT_LT(error.share(), 0.01) << graph << " at " << seconds;
        EXPECT_GT(error.shadowed, 50u);
      }
      EXPECT_NE(shown[0], shown[1]);
      EXPECT_NE(shown[1], shown[2]);
      renderer.seek(0);
      renderer.render(TimingMode::none);
      renderer.render(TimingMode::none);  // stays
      EXPECT_EQ(renderer.seconds(), 0.0);
      const Image image = renderer.read("visibility");
      EXPECT_TRUE(std::equal(shown[0].begin(), shown[0].end(), image.plane(0).begin()));
      const auto& all = validation_messages(*device());
      for (size_t i = messages; i < all.size(); ++i) ADD_FAILURE() << all[i];
    }
  }
}

}  // namespace
}  // namespace gnomon
