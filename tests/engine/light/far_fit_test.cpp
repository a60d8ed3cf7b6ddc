// Views of lights whose scene has something far away: fitted to what matters, and to all where that matters.
#include <gtest/gtest.h>

#include "engine/light/casts_beyond.h"
#include "engine/light/light_fit.h"
#include "engine/light/light_view.h"
#include "tests/engine/truth/far_scenes.h"

namespace gnomon {
namespace {

using namespace analytic;

std::vector<LightView> views_of(const Scene& scene) {
  return light_views(scene, 256, 4, SeenFrom{scene.cameras[0], 1.5});
}

void expect_same_range(const std::vector<LightView>& a, const std::vector<LightView>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].near, b[i].near, 1e-12 * a[i].near);
    EXPECT_NEAR(a[i].far, b[i].far, 1e-12 * a[i].far);
    EXPECT_NEAR(a[i].half_width, b[i].half_width, 1e-12 * a[i].half_width);
    EXPECT_NEAR(a[i].half_height, b[i].half_height, 1e-12 * a[i].half_height);
  }
}

TEST(FarFit, ADomeAroundALightChangesNothing) {
  for (const LightType type : {LightType::spot, LightType::point})
    for (const float radius : {1e3f, 2e4f, 1e6f, 1e8f}) {
      SCOPED_TRACE(std::string(name_of(type)) + " " + std::to_string(radius));
      Scene scene = plate_scene(type);
      const std::vector<LightView> none = views_of(scene);
      add(scene, dome(radius), {0, 0, 0});
      const std::vector<LightView> with = views_of(scene);
      expect_same_range(none, with);
      if (type == LightType::point) {
        EXPECT_GT(with[0].farthest, 0.9 * radius);
      }
    }
}

TEST(FarFit, StrayTrianglesChangeNothing) {
  for (const LightType type : {LightType::spot, LightType::point, LightType::directional})
    for (const glm::vec3 at :
         {glm::vec3(1e8f, 0, 0), {0, 1e8f, -1e8f}, {-3e5f, -1e7f, 2e6f}, {0, -1e3f, 0}}) {
      SCOPED_TRACE(name_of(type));
      Scene scene = plate_scene(type);
      const std::vector<LightView> none = views_of(scene);
      add(scene, triangle(at, at + glm::vec3(90, 0, 0), at + glm::vec3(0, 100, 50)), {0, 0, 0});
      expect_same_range(none, views_of(scene));
    }
}

// Two squares far below, in view: the upper one casts on the lower one.
TEST(FarFit, FarShadowsThatAreSeenAreShown) {
  for (const LightType type : {LightType::point, LightType::directional}) {
    Scene scene = plate_scene(type);
    scene.cameras[0] = camera({0.5, 3, 0.6}, {0, 0, 0});
    add(scene, square(5000), {0, -1000, 0});
    const std::vector<LightView> alone = views_of(scene);  // one square casts on nothing
    add(scene, square(500), {0, -900, 0});
    if (type == LightType::point) {
      EXPECT_LT(alone[3].far, 2);
      EXPECT_GT(views_of(scene)[3].far, 1000);
    } else {
      EXPECT_GT(views_of(scene)[0].half_width, 1000);
    }
    scene.cameras[0] = camera({0.5, 3, 0.6}, {1, 4, 1});  // looks away
    EXPECT_LT(views_of(scene)[0].half_width, 2);
    scene.cameras[0].moving = true;  // and may look back
    EXPECT_GT(std::max(views_of(scene).back().far, views_of(scene)[0].half_width), 1000);
  }
}

TEST(FarFit, OrdinaryScenesAreShownWhole) {
  for (const LightType type : {LightType::spot, LightType::point, LightType::directional}) {
    const Scene scene = square_over_plane(light(type, {1.5, 7, 1}));
    const auto whole = light_views(scene, 256, 4), seen = views_of(scene);
    for (size_t i = 0; i < whole.size(); ++i) {
      EXPECT_EQ(seen[i].light_from_world, whole[i].light_from_world);
      EXPECT_EQ(seen[i].half_width, whole[i].half_width);
      EXPECT_EQ(seen[i].near, whole[i].near);
      EXPECT_EQ(seen[i].far, whole[i].far);
      EXPECT_EQ(seen[i].farthest, whole[i].far == 2 ? 2 : seen[i].farthest);
    }
  }
}

TEST(FarFit, MovingScenesAreFittedAlike) {
  Scene scene = plate_scene(LightType::point);
  add(scene, dome(1e5f), {0, 0, 0});
  scene.instances[1].moving = true;
  const SeenFrom seen{scene.cameras[0], 1.5};
  const LightFit fit(scene, 256, 4, seen);
  for (const double height : {0.01, 0.05}) {
    scene.instances[1].world_from_object[3].y = height;
    expect_same_range(light_views(scene, 256, 4, seen), fit.views(scene));
    EXPECT_LT(fit.views(scene)[0].far, 1);
  }
}

}  // namespace
}  // namespace gnomon
