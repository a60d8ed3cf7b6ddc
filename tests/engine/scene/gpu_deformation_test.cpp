// What changes within a scene on the device: shapes, visibility and masks, against still scenes and the ray
// tracer; and cameras that end or have an aspect of their own.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/animation.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

// A square at height 2 above a plane, with an animation that has one node.
struct Changing {
  Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {0.5, 7, 0.5}));
  std::shared_ptr<Animation> animation = std::make_shared<Animation>();
  Changing() {
    animation->nodes.emplace_back();
    scene.animation = animation;
    scene.instances[1].moving = true;
  }
};

// Plays through the times; each frame must have the bits of the still scene then, and be the ray tracer's.
void expect_poses(const Changing& changing, const std::vector<double>& times,
                  const std::function<void(Scene&, double)>& still_at,
                  const std::vector<const char*>& graphs = {"shadow_mapping", "shadow_volumes"}) {
  const RenderSettings s = hard_shadow::settings(true);
  for (const char* graph : graphs) {
    const size_t messages = validation_messages(*hard_shadow::device()).size();
    Renderer renderer(hard_shadow::device(), std::make_shared<const Scene>(changing.scene),
                      load_graph(find_graph(graph)), s);
    for (const double seconds : times) {
      renderer.seek(seconds);
      renderer.render(TimingMode::none);
      const Image image = renderer.read("visibility");
      const std::vector<float> shown(image.plane(0).begin(), image.plane(0).end());
      Scene still = posed(changing.scene, seconds);
      still.animation = nullptr;
      still_at(still, seconds);
      EXPECT_EQ(shown, hard_shadow::visibility(graph, still, s)[0]) << graph << " at " << seconds;
      const auto error = hard_shadow::compare({{shown}, {}, {}}, hard_shadow::trace(still, s));
      EXPECT_LT(error.share(), 0.01) << graph << " at " << seconds;
    }
    const auto& all = validation_messages(*hard_shadow::device());
    for (size_t i = messages; i < all.size(); ++i) ADD_FAILURE() << all[i];
  }
}

TEST(GpuDeformation, MorphTargetsAreThoseOfTheReference) {
  Changing changing;
  const Mesh& mesh = changing.scene.meshes[1];
  Deformation deformation;
  deformation.mesh = 1, deformation.node = 0;
  deformation.positions = mesh.positions, deformation.normals = mesh.normals;
  // One corner is pulled out and up, all move along x.
  deformation.targets = {{{{0, 0, 0}, {0, 0, 0}, {2, 1, 2}, {0, 0, 0}}, {}}, {{4, {1, 0, 0}}, {}}};
  deformation.targets[1].positions.assign(4, {1, 0, 0});
  deformation.weights = {0, 0};
  changing.animation->nodes[0].weights = WeightTrack{Interpolation::linear, {0, 1}, {0, 0, 1, 1}, 2};
  changing.animation->deformations.push_back(deformation);
  expect_poses(changing, {0, 0.5, 1, 0.25}, [&](const Scene& still, double seconds) {
    EXPECT_EQ(still.meshes[1].positions[2], mesh.positions[2] + float(seconds) * glm::vec3(3, 1, 2));
  });
}

TEST(GpuDeformation, SkinsAreThoseOfTheReference) {
  Changing changing;
  const Mesh& mesh = changing.scene.meshes[1];
  Deformation deformation;
  deformation.mesh = 1;
  deformation.positions = mesh.positions, deformation.normals = mesh.normals;
  deformation.joints = {{0, glm::dmat4(1.0)}};
  deformation.influences = 1;
  deformation.joint_of.assign(4, 0);
  deformation.weight_of.assign(4, 1);
  deformation.mesh_from_world = glm::inverse(changing.scene.instances[1].world_from_object);
  NodeTransform rest;
  rest.translation = {0, 2, 0};
  changing.animation->nodes[0].rest = rest;
  const double half = std::sqrt(0.5) * 0.5;
  changing.animation->nodes[0].rotation =
      Track{Interpolation::linear, {0, 1}, {{0, 0, 0, 1}, {0, 0, half, std::sqrt(1 - half * half)}}};
  changing.animation->nodes[0].moving = true;
  changing.animation->deformations.push_back(deformation);
  expect_poses(changing, {0, 1, 0.5}, [](const Scene&, double) {});
}

// A hidden instance is as one that is not there.
TEST(GpuDeformation, HiddenInstancesAreNotThere) {
  Changing changing;
  changing.animation->nodes[0].visibility =
      Track{Interpolation::step, {0, 1, 2}, {{1, 0, 0, 0}, {0, 0, 0, 0}, {1, 0, 0, 0}}};
  changing.animation->nodes[0].moving = true;
  changing.animation->instances.push_back({1, 0, changing.scene.instances[1].world_from_object});
  expect_poses(changing, {0, 1, 2, 1.5}, [](Scene& still, double seconds) {
    EXPECT_EQ(still.instances[1].visible, seconds < 1 || seconds >= 2);
    if (still.instances[1].visible) return;
    still.instances.pop_back();
    still.meshes.pop_back();
  });
}

// The square's mask opens: half of its texels have an alpha of a half.
TEST(GpuDeformation, MasksChange) {
  Changing changing;
  Texture texture;
  texture.width = 2;
  texture.rgba = {255, 255, 255, 255, 255, 255, 255, 128};
  texture.nearest = true;
  changing.scene.textures.push_back(texture);
  Material& material = changing.scene.materials[1];
  material.alpha_masked = material.double_sided = true;
  material.base_color_texture = 0;
  changing.animation->changing_materials.push_back(
      {1,
       material.base_color,
       material.alpha_cutoff,
       {},
       Track{Interpolation::step, {0, 1}, {{0.25, 0, 0, 0}, {0.75, 0, 0, 0}}}});
  const auto opened = [](const Scene& still, double seconds) {
    EXPECT_EQ(still.materials[1].alpha_cutoff, seconds < 1 ? 0.25f : 0.75f);
  };
  expect_poses(changing, {0, 1}, opened, {"shadow_mapping"});  // shadow volumes have no masks
}

// Beyond the far plane there is nothing, in the image as in the reference.
TEST(GpuCamera, TheFarPlaneCutsOff) {
  Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {0.5, 7, 0.5}));
  const RenderSettings s = hard_shadow::settings(true);
  const Reference whole = hard_shadow::trace(scene, s);
  scene.cameras[0].far = 12.2;  // of the plane's middle, where the shadow is
  const Reference reference = hard_shadow::trace(scene, s);
  for (const char* graph : {"shadow_mapping", "shadow_volumes"}) {
    const auto run = hard_shadow::render(graph, scene, s);
    EXPECT_LT(hard_shadow::compare(run, reference).share(), 0.01) << graph;
    size_t cut = 0, drawn = 0;
    for (size_t i = 0; i < reference.depth.size(); ++i) {
      if (!std::isinf(reference.depth[i]) || whole.visibility[0][i] > 0) continue;
      ++cut;
      drawn += run.visibility[0][i] == 0;  // the background is lit
    }
    EXPECT_GT(cut, 100u) << graph;
    EXPECT_LT(drawn, cut / 20) << graph;  // along the edge
  }
}

TEST(GpuCamera, AnAspectOfItsOwnIsThatOfTheReference) {
  Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {0.5, 7, 0.5}));
  const RenderSettings s = hard_shadow::settings(true);
  const auto plain = hard_shadow::visibility("shadow_mapping", scene, s)[0];
  for (const double aspect : {0.75, 2.5}) {
    scene.cameras[0].aspect = aspect;
    for (const char* graph : {"shadow_mapping", "shadow_volumes"}) {
      const auto run = hard_shadow::render(graph, scene, s);
      EXPECT_LT(hard_shadow::compare(run, hard_shadow::trace(scene, s)).share(), 0.01) << graph;
      bool told = false;
      for (const std::string& warning : run.warnings) told |= warning.find("aspect") != std::string::npos;
      EXPECT_TRUE(told);
    }
    EXPECT_EQ(hard_shadow::visibility("shadow_mapping", scene, s)[0] == plain, aspect < 1);
  }
}

}  // namespace
}  // namespace gnomon
