// What cameras show in images of other shapes.
#include "engine/scene/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/truth/reference.h"
#include "tests/engine/scene/gltf_draft.h"
#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

using test::Draft;
using test::load;
using test::warns;

TEST(Camera, AnotherAspectIsWhollyInTheImage) {
  Camera camera;
  camera.fov_y = 1;
  const double own = std::tan(0.5);
  EXPECT_EQ(half_extent(camera, 1.5), glm::dvec2(own * 1.5, own));
  EXPECT_EQ(aspect_warning(camera, 1.5), "");
  camera.aspect = 1;  // narrower than the image: more at the sides
  EXPECT_EQ(half_extent(camera, 1.5), glm::dvec2(own * 1.5, own));
  EXPECT_NE(aspect_warning(camera, 1.5).find("more at the sides"), std::string::npos);
  camera.aspect = 3;  // wider: more above and below, three times as wide as high
  EXPECT_NEAR(half_extent(camera, 1.5).x, own * 3, 1e-12);
  EXPECT_NEAR(half_extent(camera, 1.5).y, own * 2, 1e-12);
  EXPECT_NE(aspect_warning(camera, 1.5).find("more above and below"), std::string::npos);
  camera.aspect = 1.5;
  EXPECT_EQ(half_extent(camera, 1.5).y, own);
}

// A sphere in the middle of the view is as wide as high.
TEST(Camera, ShapesAreKept) {
  for (const double aspect : {0.5, 1.0, 1.5, 4.0}) {
    Scene scene;
    analytic::add(scene, analytic::sphere(1, 24, 48), {0, 0, 0});
    scene.cameras.push_back(analytic::camera({0, 0, 6}, {0, 0, 0}));
    scene.cameras[0].aspect = aspect;
    scene.lights.push_back(analytic::light(LightType::spot, {1, 5, 3}));
    ReferenceSettings settings;
    settings.width = 90, settings.height = 60;
    const Reference reference = ReferenceTracer(scene).trace(settings);
    uint32_t left = 90, right = 0, top = 60, bottom = 0;
    for (uint32_t y = 0; y < 60; ++y)
      for (uint32_t x = 0; x < 90; ++x) {
        if (std::isinf(reference.depth[y * 90 + x])) continue;
        left = std::min(left, x), right = std::max(right, x);
        top = std::min(top, y), bottom = std::max(bottom, y);
      }
    EXPECT_EQ(right - left, bottom - top) << aspect;
    EXPECT_GT(right, left);
  }
}

TEST(Camera, TheFarPlaneIsRead) {
  Draft draft;
  draft.document["nodes"].push_back({{"camera", 0}});
  draft.document["scenes"][0]["nodes"] = {0, 1};
  draft.document["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.5}, {"zfar", 20}}}}};
  const Scene scene = load(draft);
  EXPECT_EQ(scene.cameras[0].far, 20);
  EXPECT_FALSE(far_plane_cuts(scene, scene.cameras[0]));
  draft.document["nodes"][0]["translation"] = {0, 0, -20.5};
  EXPECT_TRUE(far_plane_cuts(load(draft), load(draft).cameras[0]));
  draft.document["cameras"][0]["perspective"]["zfar"] = 0.25;
  EXPECT_FALSE(load(draft).cameras[0].far);
  EXPECT_TRUE(warns(load(draft), "zfar is not above znear"));
  draft.document["cameras"][0]["perspective"].erase("zfar");
  EXPECT_FALSE(load(draft).cameras[0].far);
  EXPECT_FALSE(warns(load(draft), "zfar"));
}

TEST(Camera, OrthographicOnesAreRead) {
  Draft draft;
  draft.document["nodes"].push_back({{"camera", 0}});
  draft.document["scenes"][0]["nodes"] = {0, 1};
  const nlohmann::json view = {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 20}};
  draft.document["cameras"] = {{{"type", "orthographic"}, {"orthographic", view}}};
  const Scene scene = load(draft);
  ASSERT_TRUE(scene.cameras[0].span);
  EXPECT_EQ(*scene.cameras[0].span, glm::dvec2(3, 2));
  EXPECT_EQ(scene.cameras[0].near, 0);
  EXPECT_EQ(scene.cameras[0].far, 20);
  EXPECT_EQ(half_extent(scene.cameras[0], 1.5), glm::dvec2(3, 2));
  EXPECT_EQ(half_extent(scene.cameras[0], 3), glm::dvec2(6, 2));
  EXPECT_NEAR(half_extent(scene.cameras[0], 1).y, 3, 1e-12);
  EXPECT_FALSE(warns(scene, "camera"));
  draft.document["cameras"][0]["orthographic"]["xmag"] = 0;
  EXPECT_TRUE(warns(load(draft), "xmag or ymag is not a number other than 0"));
  draft.document["cameras"][0]["orthographic"]["xmag"] = -3;
  EXPECT_EQ(load(draft).cameras[0].span->x, 3);
  EXPECT_TRUE(warns(load(draft), "not mirrored"));
}

}  // namespace
}  // namespace gnomon
