// Percentage-closer soft shadows, held against closed forms: half planes, other maps, other lights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/passes/soft/half_plane.h"

namespace gnomon {
namespace {

using namespace half_plane_test;

struct Case {
  const char* name;
  AreaLight::Shape shape;
  double width;
  int taps;
  double (*share)(double, double);
  double tolerance;
};
class PcssHalfPlane : public testing::TestWithParam<Case> {};
// The edge is on a border between texels. A lattice of taps^2 tests meets it in as many steps; a disc's are
// not as even.
INSTANTIATE_TEST_SUITE_P(
    All, PcssHalfPlane,
    testing::Values(Case{"wide", AreaLight::Shape::rectangle, 1.0, 16, rectangle_share, 1.0 / 256},
                    Case{"narrow", AreaLight::Shape::rectangle, 0.2, 16, rectangle_share, 1.0 / 256},
                    Case{"disc", AreaLight::Shape::disc, 1.0, 16, disc_share, 1.0 / 64},
                    Case{"sphere", AreaLight::Shape::sphere, 0.6, 32, disc_share, 1.0 / 128}),
    [](const auto& info) { return std::string(info.param.name); });

TEST_P(PcssHalfPlane, IsTheShareOfTheLight) {
  const Case& c = GetParam();
  const Scene scene = half_plane(area(c.shape, c.width, c.width));
  const Frame frame = render(scene, {{"taps", std::int64_t(c.taps)}});
  const auto all = places(scene);
  ASSERT_GT(all.size(), 3000u);
  size_t partly = 0;
  for (const Place& p : all) {
    const double wanted = c.share(p.position.x, c.width);
    ASSERT_NEAR(frame.visibility[p.pixel], wanted, c.tolerance + 1e-4) << p.position.x;
    partly += wanted > 0 && wanted < 1;
    if (wanted <= 0.01 || wanted >= 0.99) continue;
    ASSERT_NEAR(frame.blocker[p.pixel], kBlocker, 1e-3);
    ASSERT_NEAR(frame.width[p.pixel], penumbra(c.width), 1e-3);
  }
  EXPECT_GT(partly, 300u);
}

// Half of the penumbra that an error of half a texel in the edge's place changes, and the disc's taps.
void expect_disc_share(const Scene& scene, double width, double tolerance) {
  const Frame frame = render(scene, {{"taps", std::int64_t(32)}});
  size_t partly = 0;
  for (const Place& p : places(scene)) {
    const double wanted = disc_share(p.position.x, width);
    ASSERT_NEAR(frame.visibility[p.pixel], wanted, tolerance) << p.position.x;
    if (wanted <= 0.05 || wanted >= 0.95) continue;
    ++partly;
    ASSERT_NEAR(frame.width[p.pixel], penumbra(width), 1e-2 * width);
  }
  EXPECT_GT(partly, 300u);
}

TEST(Pcss, ASphereAroundAPointLightIsItsDisc) {
  Scene scene = half_plane(area(AreaLight::Shape::sphere, 0.8, 0.8));
  scene.lights[0].type = LightType::point;
  expect_disc_share(scene, 0.8, 1.0 / 100);
}

TEST(Pcss, ADirectionalLightIsAsWideAsItsAngle) {
  constexpr double kAngle = 0.25;  // radians
  Scene scene = half_plane(angular_disc(kAngle));
  scene.lights[0].type = LightType::directional;
  // penumbra() has the blocker halfway to the light: what is as wide there is as wide as the light.
  const double width = 2 * std::tan(0.5 * kAngle) * (kReceiver - kBlocker);
  const double texel = 24.0 / 1024;  // of the map, which holds the floor; the edge is not on its border
  expect_disc_share(scene, width, 1.0 / 100 + 4 / M_PI * 0.5 * texel / width);
}

// The kernel is a scaled copy of the light: its other side does not count beside an edge that runs along it.
TEST(Pcss, SidesOfALightCountByThemselves) {
  const Scene scene = half_plane(area(AreaLight::Shape::rectangle, 0.5, 1.5));
  const Frame frame = render(scene, {{"taps", std::int64_t(16)}});
  // The light's x axis may run along the world's x or z.
  const glm::dvec3 axis(scene.lights[0].world_from_light[0]);
  const double across = std::abs(axis.x) > 0.5 ? 0.5 : 1.5;
  for (const Place& p : places(scene))
    ASSERT_NEAR(frame.visibility[p.pixel], rectangle_share(p.position.x, across), 1.0 / 256 + 1e-4)
        << p.position.x;
}

// A light 1 wide of which the half on the side of its own x axis shines.
std::vector<std::pair<const char*, Scene>> half_lit() {
  AreaLight textured = area(AreaLight::Shape::rectangle, 1, 1);
  textured.emission = 0;
  Scene by_texture = half_plane(textured);
  Texture right;  // its left column is black
  right.width = 2, right.height = 1, right.nearest = true;
  right.rgba = {0, 0, 0, 255, 255, 255, 255, 255};
  by_texture.textures.push_back(right);
  const Scene by_shape = half_plane(polygon_light({{0, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {0, 0.5}}));
  return {{"texture", by_texture}, {"polygon", by_shape}};
}

TEST(Pcss, PartsOfALightCountByTheirEmissionAndAreNotFlipped) {
  for (const auto& [name, scene] : half_lit()) {
    const double side = scene.lights[0].world_from_light[0].x;
    ASSERT_NEAR(std::abs(side), 1, 1e-6);
    const double from = side > 0 ? 0 : -0.5;  // of what shines; it ends 1/2 further
    const Frame frame = render(scene);
    for (const Place& p : places(scene)) {
      // The blocker is halfway: it leaves what is beyond the receiver's mirror image.
      const double wanted = std::clamp(2 * (from + 0.5 - std::max(-p.position.x, from)), 0.0, 1.0);
      ASSERT_NEAR(frame.visibility[p.pixel], wanted, 1.0 / 100) << name << ' ' << p.position.x;
    }
  }
}

TEST(Pcss, WidthIsProportionalToTheLight) {
  const Scene one = half_plane(area(AreaLight::Shape::rectangle, 0.3, 0.3));
  const Scene two = half_plane(area(AreaLight::Shape::rectangle, 0.6, 0.6));
  const Frame a = render(one), b = render(two);
  size_t both = 0;
  for (const Place& p : places(one)) {
    if (a.width[p.pixel] == 0 || b.width[p.pixel] == 0) continue;
    ++both;
    ASSERT_NEAR(b.width[p.pixel], 2 * a.width[p.pixel], 1e-3);
  }
  EXPECT_GT(both, 300u);
}

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i) most = std::max(most, double(std::abs(a[i] - b[i])));
  return most;
}

// On the floor: the edge is on a texel's border in all of these maps.
TEST(Pcss, NoMapAndNoRangeOfDepthChangesTheShadow) {
  const AreaLight size = area(AreaLight::Shape::rectangle, 1, 1);
  const Scene scene = half_plane(size);
  const auto at = places(scene);
  const Values taps{{"taps", std::int64_t(16)}};
  const auto standard = render(scene, taps).visibility;
  const auto expect_same = [&](const Frame& frame, const std::string& what) {
    double most = 0;
    for (const Place& p : at)
      most = std::max(most, double(std::abs(frame.visibility[p.pixel] - standard[p.pixel])));
    EXPECT_LE(most, 1.0 / 255) << what;
  };
  expect_same(render(half_plane(size, 2.0), taps), "fov");
  for (const int side : {512, 2048})
    expect_same(render(scene, {{"taps", std::int64_t(16)}, {"shadow_map", std::int64_t(side)}}),
                std::to_string(side));
  expect_same(render(scene, {{"taps", std::int64_t(16)}, {"depth", std::string("linear")}}), "linear depth");
  Scene deeper = scene;  // something below the floor moves the far plane
  analytic::add(deeper, analytic::square(0.5f), {20, -20, 20});
  expect_same(render(deeper, taps), "far plane");
}

TEST(Pcss, ALightWithoutSizeIsThePlainTest) {
  Scene scene = half_plane(area(AreaLight::Shape::rectangle, 1, 1));
  scene.lights[0].area.reset();
  RenderSettings s;
  s.width = kWidth, s.height = kHeight;
  const auto soft = hard_shadow::visibility("pcss", scene, s);
  EXPECT_EQ(soft, hard_shadow::visibility("shadow_mapping", scene, s));
  s.keep_all = true;
  EXPECT_EQ(soft, hard_shadow::visibility("pcss", scene, s));
}

TEST(Pcss, PixelsThatNothingHidesTheLightFromHaveNoBlocker) {
  const Scene scene = half_plane(area(AreaLight::Shape::rectangle, 0.2, 0.2));
  const Frame frame = render(scene);
  size_t lit = 0;
  for (const Place& p : places(scene)) {
    if (p.position.x < 0.2) continue;  // twice the penumbra's half
    ++lit;
    ASSERT_EQ(frame.blocker[p.pixel], 0.0f);
    ASSERT_EQ(frame.width[p.pixel], 0.0f);
    ASSERT_EQ(frame.visibility[p.pixel], 1.0f);
  }
  EXPECT_GT(lit, 300u);
}

// With the pyramid only penumbrae are filtered, which changes nothing.
TEST(Pcss, FilteringEveryPixelChangesNothing) {
  for (const auto shape : {AreaLight::Shape::rectangle, AreaLight::Shape::disc}) {
    const Scene scene = half_plane(area(shape, 0.7, 0.7));
    RenderSettings s;
    s.width = kWidth, s.height = kHeight;
    const auto some = hard_shadow::visibility("pcss", scene, s);
    s.keep_all = true;
    EXPECT_LE(largest_difference(some[0], hard_shadow::visibility("pcss", scene, s)[0]), 1e-6);
  }
}

// Lights from nothing to larger than the scene, both protocols, both kinds of taps: finite, in [0, 1].
TEST(Pcss, StaysInRangeForAnyLight) {
  for (const double size : {1e-6, 0.01, 3.0, 100.0, 1e6})
    for (const char* protocol : {"exact", "thesis"})
      for (const char* sampling : {"box", "vogel"}) {
        const Frame frame =
            render(half_plane(area(AreaLight::Shape::disc, size, size)),
                   {{"protocol", std::string(protocol)}, {"sampling", std::string(sampling)}});
        for (const float v : frame.visibility)
          ASSERT_TRUE(v >= 0 && v <= 1) << size << ' ' << protocol << ' ' << v;
        for (const float v : frame.width) ASSERT_TRUE(std::isfinite(v) && v >= 0) << size << ' ' << v;
        for (const float v : frame.blocker) ASSERT_TRUE(std::isfinite(v) && v >= 0) << size << ' ' << v;
      }
}

TEST(Pcss, ThesisProtocolFiltersPenumbraeToo) {
  const Scene scene = half_plane(area(AreaLight::Shape::rectangle, 0.05, 0.05));
  const Frame frame = render(scene, {{"protocol", std::string("thesis")}});
  for (const Place& p : places(scene))
    ASSERT_NEAR(frame.visibility[p.pixel], rectangle_share(p.position.x, 0.05), 0.1) << p.position.x;
}

}  // namespace
}  // namespace gnomon
