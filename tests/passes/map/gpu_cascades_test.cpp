// Cascades against one map of the same memory, and against the ray tracer.
#include <gtest/gtest.h>

#include "engine/base/resource_root.h"
#include "engine/scene/animation.h"
#include "tests/engine/scene/moving_scenes.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using namespace hard_shadow;

Misclassified misclassified(const Scene& scene, const Reference& reference, int64_t map, int64_t cascades) {
  const RenderSettings s = settings(true, reference.width, reference.height);
  return compare(render("shadow_mapping", scene, s, {{"shadow_map", map}, {"cascades", cascades}}),
                 reference);
}

TEST(GpuCascades, FourOfAQuarterTheTexelsBeatOneMap) {
  const Scene scene = load_scene(resource_root() / "assets" / "scenes" / "hills.glb");
  const Reference reference = trace(scene, settings(true, 320, 180));
  const Misclassified one = misclassified(scene, reference, 1024, 1),
                      four = misclassified(scene, reference, 512, 4);
  std::printf("hills: one map of 1024 %.3f %%, four of 512 %.3f %%\n", 100 * one.share(), 100 * four.share());
  EXPECT_GT(one.wrong, 300u);
  EXPECT_LT(four.share(), 0.7 * one.share());
}

// Each cascade more makes the finest part finer: never worse beyond noise, and the same picture.
TEST(GpuCascades, AnyNumberShowsTheSameShadow) {
  const Scene scene = load_scene(resource_root() / "assets" / "scenes" / "hills.glb");
  const Reference reference = trace(scene, settings(true, 320, 180));
  const double one = misclassified(scene, reference, 512, 1).share();
  for (const int64_t cascades : {2, 3, 5, 8})
    EXPECT_LT(misclassified(scene, reference, 512, cascades).share(), one) << cascades;
}

// What moves with the camera is what a camera that stands there has.
TEST(GpuCascades, FollowTheCamera) {
  const Scene still = analytic::square_over_plane(analytic::light(LightType::directional, {1.5, 7, 1}));
  const Scene scene = analytic::Mover(still).camera({3, 0, -2}).scene;
  const Values set{{"shadow_map", int64_t{128}}, {"cascades", int64_t{3}}, {"cache", true}};
  const Graph graph = load_graph(find_graph("shadow_mapping"), set);
  Renderer renderer(device(), std::make_shared<Scene>(scene), graph, settings(true));
  for (const double time : {0.0, 0.5, 1.0}) {
    renderer.seek(time);
    renderer.render(TimingMode::none);
    const Image image = renderer.read("visibility");
    const std::vector<float> moved(image.plane(size_t{0}).begin(), image.plane(size_t{0}).end());
    Scene there = posed(scene, time);
    there.animation = nullptr;
    EXPECT_EQ(moved, visibility(graph, there, settings(true))[0]) << time;
  }
}

}  // namespace
}  // namespace gnomon
