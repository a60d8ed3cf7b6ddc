// Back-projection, held against closed forms: half planes, a square, textured lights, other maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/scene/area_light.h"
#include "tests/passes/soft/soft_scenes.h"

namespace gnomon {
namespace {

using namespace soft_scenes;

// A straight edge along an axis meets the light's points in 32 steps, across the middle of a disc in steps 4
// / pi as high.
constexpr double kPoints = 1.0 / 32;
constexpr double kDiscPoints = 4 / M_PI * kPoints;

class BackProjection : public testing::TestWithParam<const char*> {
 public:
  std::vector<float> render(const Scene& scene, const Values& set = {}, bool keep_all = false) const {
    return soft_scenes::render(GetParam(), scene, set, keep_all);
  }
};
INSTANTIATE_TEST_SUITE_P(All, BackProjection, testing::Values("back_projection", "rb_back_projection"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(BackProjection, OfAHalfPlaneIsTheShareOfTheLight) {
  for (const auto shape : {AreaLight::Shape::rectangle, AreaLight::Shape::disc, AreaLight::Shape::sphere})
    for (const double width : {0.2, 1.0, 2.5}) {
      const Scene scene = half_plane(area(shape, width, width));
      const auto share = shape == AreaLight::Shape::rectangle ? rectangle_share : disc_share;
      EXPECT_GT(expect_shares(
                    render(scene), scene, [&](const glm::dvec3& p) { return share(p.x, width); }, kPoints),
                200u)
          << width;
    }
}

TEST_P(BackProjection, OfASphereAboutAPointLightIsThatOfItsDisc) {
  Scene scene = half_plane(area(AreaLight::Shape::sphere, 0.8, 0.8));
  scene.lights[0].type = LightType::point;
  EXPECT_GT(expect_shares(
                render(scene), scene, [](const glm::dvec3& p) { return disc_share(p.x, 0.8); }, 2 * kPoints),
            200u);
}

TEST_P(BackProjection, OfADirectionalLightIsAsWideAsItsAngle) {
  constexpr double kAngle = 0.25;  // radians
  Scene scene = half_plane(angular_disc(kAngle));
  scene.lights[0].type = LightType::directional;
  // penumbra() has the blocker halfway to the light: what is as wide there is as wide as the light.
  const double width = 2 * std::tan(0.5 * kAngle) * (kReceiver - kBlocker);
  const double texel = 24.0 / 1024;  // of the map, which holds the floor; the edge is not on its border
  EXPECT_GT(expect_shares(
                render(scene), scene, [&](const glm::dvec3& p) { return disc_share(p.x, width); },
                kPoints + 4 / M_PI * 0.5 * texel / width),
            200u);
}

// A square parallel to the light and to the receiver hides a rectangle: its sides' shares, multiplied.
TEST_P(BackProjection, OfASquareIsTheProductOfItsSides) {
  constexpr double kHalf = 0.5, kLight = 1.5;
  Scene scene = floor_under(area(AreaLight::Shape::rectangle, kLight, kLight));
  analytic::add(scene, analytic::square(float(kHalf)), {0, kReceiver - kBlocker, 0});
  const auto hidden = [&](double x) {  // along one axis: of the light from x - 2 kHalf.. on the floor
    const double shadow = kHalf * kReceiver / kBlocker, wide = penumbra(kLight);
    const double low = std::max(-shadow, x - 0.5 * wide), high = std::min(shadow, x + 0.5 * wide);
    return std::max(high - low, 0.0) / wide;
  };
  EXPECT_GT(expect_shares(
                render(scene), scene, [&](const glm::dvec3& p) { return 1 - hidden(p.x) * hidden(p.z); },
                2 * kPoints),
            1000u);
}

// Half of the light emits: the shadow's edge stands at that half's side, as rays from there have it.
TEST_P(BackProjection, DoesNotFlipATexturedLight) {
  Texture half;
  half.width = 2, half.height = 1, half.nearest = true;
  half.rgba = {255, 255, 255, 255, 0, 0, 0, 255};  // emits at -x
  Scene scene = half_plane(area(AreaLight::Shape::rectangle, 1.0, 1.0));
  scene.textures.push_back(half);
  scene.lights[0].area->emission = 0;
  const glm::dmat4& world = scene.lights[0].world_from_light;
  const double middle = (world * glm::dvec4(-0.25, 0, 0, 0)).x;  // of the half that emits
  // Seen from there the edge at x = 0 throws its shadow to the other side.
  EXPECT_GT(expect_shares(
                render(scene), scene,
                [&](const glm::dvec3& p) {
                  const double edge = -middle * (kReceiver - kBlocker) / kBlocker;
                  return std::abs(middle) > 0.1 ? rectangle_share(p.x - edge, 0.5)
                                                : rectangle_share(p.x, 1.0);
                },
                2 * kPoints),
            200u);
}

TEST_P(BackProjection, IsTheSameThroughOtherMaps) {
  const Scene scene = half_plane(area(AreaLight::Shape::rectangle, 1, 1));
  const auto standard = render(scene);
  const auto expect_same = [&](const std::vector<float>& other, const std::string& what) {
    size_t beyond = 0;  // where an edge meets points exactly, roundings decide on which side they are
    const auto all = places(scene);
    for (const Place& p : all) {
      const double difference = std::abs(other[p.pixel] - standard[p.pixel]);
      beyond += difference > 1.0 / 255;
      ASSERT_LE(difference, kPoints + 1e-4) << what << ' ' << p.position.x;
    }
    EXPECT_LE(beyond, all.size() / 50) << what;
  };
  expect_same(render(half_plane(area(AreaLight::Shape::rectangle, 1, 1), 2.0)), "field of view");
  expect_same(render(scene, {{"depth", std::string("linear")}}), "linear depth");
  expect_same(render(scene, {{"shadow_map", std::int64_t(512)}}), "512");
  expect_same(render(scene, {{"shadow_map", std::int64_t(2048)}}), "2048");
  Scene deeper = scene;  // something below the floor moves the far plane
  analytic::add(deeper, analytic::square(0.5f), {20, -20, 20});
  expect_same(render(deeper), "far plane");
}

TEST_P(BackProjection, OfALightWithoutSizeIsThePlainTest) {
  Scene scene = half_plane(area(AreaLight::Shape::rectangle, 1, 1));
  scene.lights[0].area.reset();
  const Values bias{{"bias_constant", 0.5}};
  EXPECT_EQ(render(scene, bias), soft_scenes::render("shadow_mapping", scene, {}, false));
  EXPECT_EQ(render(scene, bias, true), soft_scenes::render("shadow_mapping", scene, {}, false));
}

TEST_P(BackProjection, WorkingOnEveryPixelChangesNothing) {
  for (const auto shape : {AreaLight::Shape::rectangle, AreaLight::Shape::disc}) {
    const Scene scene = half_plane(area(shape, 0.7, 0.7));
    EXPECT_EQ(render(scene), render(scene, {}, true));
  }
}

// Lights from nothing to larger than the scene: finite, in [0, 1].
TEST_P(BackProjection, StaysInRangeForAnyLight) {
  for (const double size : {1e-6, 0.01, 3.0, 100.0, 1e6})
    for (const char* overlap : {"mask", "area"})
      for (const float v :
           render(half_plane(area(AreaLight::Shape::disc, size, size)), {{"overlap", std::string(overlap)}}))
        ASSERT_TRUE(v >= 0 && v <= 1) << size << ' ' << overlap << ' ' << v;
}

// A light below a surface's horizon does not shine on it: where the receiver's own plane crosses the light,
// without any caster, the share above counts.
TEST_P(BackProjection, HidesWhatIsBelowTheReceiversHorizon) {
  Scene scene;
  analytic::add(scene, analytic::square(3), {0, 0, 0});
  scene.cameras.push_back(analytic::camera({0, 4, 0.02}, {0, 0, 0}));
  // Shines along x, above the floor: a quarter of it is below.
  Light light = analytic::light(LightType::spot, {-8, 1, 0});
  light.world_from_light = analytic::frame({-8, 1, 0}, {0, 1, 0}, {0, 1, 0});
  light.map_fov = 0.5 * M_PI;
  scene.lights.push_back(light);
  scene.lights[0].area = area(AreaLight::Shape::rectangle, 4, 4);
  analytic::add(scene, analytic::square(0.02f),
                {-2.5, 0.5, 2});  // throws a shadow aside, or nothing would be done
  const auto visibility = render(scene);
  size_t count = 0;
  for (const Place& p : places(scene)) {
    if (p.position.z > 0.5) continue;
    ++count;
    ASSERT_NEAR(visibility[p.pixel], 0.75, kPoints + 1e-4) << p.position.x << ' ' << p.position.z;
  }
  EXPECT_GT(count, 1000u);
}

}  // namespace
}  // namespace gnomon
