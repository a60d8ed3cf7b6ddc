// Orthographic cameras: images against closed form, every technique against the reference.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/render/renderer.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/parameter_name.h"
#include "tests/passes/hard/hard_shadow_run.h"
#include "tests/passes/silent_test.h"

namespace gnomon {
namespace {

using namespace analytic;

constexpr double kHalf = 1, kHeight = 2;  // of square_over_plane(): its square, and how high it is

// `span`: half width and height.
Scene seen_orthographically(Scene scene, const glm::dvec3& eye, const glm::dvec2& span) {
  scene.cameras = {camera(eye, {0, 0, 0})};
  scene.cameras[0].span = span;
  scene.cameras[0].near = 0.5;
  return scene;
}

RenderSettings small() { return hard_shadow::settings(true, 96, 64); }

// Seen straight from above every pixel is a place of the plane, or of the square; the sun's shadow of the
// square is the square, moved.
TEST(Orthographic, ShadowsFromAboveHaveAClosedForm) {
  const glm::dvec3 sun(-1.5, 3, 0.5);
  Scene scene = square_over_plane(light(LightType::directional, sun));
  scene.cameras = {camera({0, 9, 1e-9}, {0, 0, 0})};
  glm::dmat4& frame = scene.cameras[0].world_from_camera;
  frame = {{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 9, 0, 1}};
  scene.cameras[0].span = glm::dvec2(4.5, 3);
  const RenderSettings s = small();
  const auto volumes = hard_shadow::visibility("shadow_volumes", scene, s)[0];
  const auto planar = hard_shadow::visibility("planar_shadows", scene, s)[0];
  const Reference r = hard_shadow::trace(scene, s);
  int dark = 0;
  for (uint32_t y = 0; y < s.height; ++y)
    for (uint32_t x = 0; x < s.width; ++x) {
      const size_t i = y * s.width + x;
      const glm::dvec2 place(9 * (x + 0.5) / s.width - 4.5, 6 * (y + 0.5) / s.height - 3);
      const glm::dvec2 moved = place + glm::dvec2(sun.x, sun.z) * (kHeight / sun.y);
      const double seen = std::max(std::abs(place.x), std::abs(place.y)) - kHalf;
      const double hidden = std::max(std::abs(moved.x), std::abs(moved.y)) - kHalf;
      if (std::abs(seen) < 1e-3 || std::abs(hidden) < 1e-3) continue;
      const bool on_square = seen < 0;
      const float truth = !on_square && hidden < 0 ? 0.0f : 1.0f;
      EXPECT_EQ(volumes[i], truth) << x << ' ' << y;
      EXPECT_EQ(planar[i], truth) << x << ' ' << y;
      EXPECT_EQ(r.visibility[0][i], truth) << x << ' ' << y;
      EXPECT_NEAR(r.depth[i], on_square ? 9 - kHeight : 9, 1e-6);
      dark += truth == 0;
    }
  EXPECT_GT(dark, 100);
}

// The view's axis, the sun's direction and what is cast all coincide; and a camera whose near plane is in
// shadow.
TEST(Orthographic, ShadowVolumesAlongTheAxisAreExact) {
  for (const glm::dvec3 sun : {glm::dvec3(3, 4, 6), {-3, -4, -6}, {0, 5, 0}, {3, 4.001, 6}}) {
    Scene scene =
        seen_orthographically(square_over_plane(light(LightType::directional, sun)), {3, 4, 6}, {4, 3});
    for (const double near : {0.0, 4.0, 6.0}) {
      scene.cameras[0].near = near;
      const auto is = hard_shadow::visibility("shadow_volumes", scene, small())[0];
      const Reference r = hard_shadow::trace(scene, small());
      int wrong = 0;
      for (size_t i = 0; i < is.size(); ++i)
        wrong += r.domain[0][i] == Reference::counted && is[i] != r.visibility[0][i];
      EXPECT_LE(wrong, 2) << sun.x << ' ' << sun.y << ", near " << near;
    }
  }
}

TEST(Orthographic, TheFarPlaneCuts) {
  Scene scene =
      seen_orthographically(square_over_plane(light(LightType::spot, {1.5, 7, 1})), {3, 4, 6}, {6, 4});
  scene.cameras[0].far = glm::length(glm::dvec3(3, 4, 6));
  Renderer renderer(hard_shadow::device(), std::make_shared<Scene>(scene),
                    load_graph(find_graph("shadow_volumes")), small());
  renderer.render(TimingMode::none);
  const Image color = renderer.read("color");
  const Reference r = hard_shadow::trace(scene, small());
  int shown = 0, cut = 0;
  for (size_t i = 0; i < r.depth.size(); ++i) {
    const bool there = !std::isinf(r.depth[i]);
    (there ? shown : cut)++;
  }
  EXPECT_GT(shown, 500);
  EXPECT_GT(cut, 500);
  const auto is = hard_shadow::visibility("shadow_volumes", scene, small())[0];
  for (size_t i = 0; i < is.size(); ++i)
    if (std::isinf(r.depth[i])) {
      EXPECT_EQ(is[i], 1.0f);
    }
}

class EveryGraphOrthographic : public test::Silent,
                               public testing::WithParamInterface<std::filesystem::path> {};
INSTANTIATE_TEST_SUITE_P(All, EveryGraphOrthographic, testing::ValuesIn(all_graphs()), test::ParameterName());

// Do all pixels around one count, and see as much of the light as it does?
bool is_away_from_edges(const Reference& r, int x, int y) {
  constexpr int kSoft = 6;  // pixels that the techniques' filters reach here
  const auto at = [&](int i, int k) { return size_t(k) * r.width + size_t(i); };
  for (int k = std::max(y - kSoft, 0); k <= std::min<int>(y + kSoft, int(r.height) - 1); ++k)
    for (int i = std::max(x - kSoft, 0); i <= std::min<int>(x + kSoft, int(r.width) - 1); ++i)
      if (r.domain[0][at(i, k)] != Reference::counted ||
          r.visibility[0][at(i, k)] != r.visibility[0][at(x, y)])
        return false;
  return true;
}

// But for soft edges every technique has the reference's shadows.
TEST_P(EveryGraphOrthographic, HasTheReferencesShadows) {
  const Graph graph = load_graph(GetParam());
  RenderSettings roomy = small();
  roomy.memory = uint64_t{1} << 31;  // six views of 8 terms
  for (const LightType type : {LightType::spot, LightType::directional, LightType::point}) {
    const glm::dvec3 at = type == LightType::directional ? glm::dvec3(8, 5, 0) : glm::dvec3(5, 7, 3);
    const Scene scene = seen_orthographically(square_over_plane(light(type, at)), {3, 40, 6}, {4.5, 3});
    const auto is = hard_shadow::visibility(graph, scene, roomy)[0];
    const Reference r = hard_shadow::trace(scene, small());
    int lit = 0, dark = 0, wrong = 0;
    for (uint32_t y = 0; y < r.height; ++y)
      for (uint32_t x = 0; x < r.width; ++x) {
        const size_t i = size_t{y} * r.width + x;
        EXPECT_GE(is[i], 0);
        EXPECT_LE(is[i], 1);
        if (!is_away_from_edges(r, int(x), int(y))) continue;
        (r.visibility[0][i] == 0 ? dark : lit)++;
        wrong += std::abs(is[i] - r.visibility[0][i]) > 0.25;
      }
    EXPECT_GT(dark, 20) << name_of(type);
    EXPECT_GT(lit, 2000) << name_of(type);
    EXPECT_LE(wrong, (dark + lit) / 100) << name_of(type);
  }
}

}  // namespace
}  // namespace gnomon
