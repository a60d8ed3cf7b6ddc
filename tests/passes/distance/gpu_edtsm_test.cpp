// EDTSM: the penumbra of a straight edge against its closed form (Macedo 2018, eq. 4.3), from near and far,
// at angles.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/graph/graph.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/parameter_name.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

constexpr double kHeight = 3, kPenumbra = 1;  // world units
constexpr uint32_t kWidth = 480, kRows = 360;

struct View {
  double distance;   // of the camera to the edge, world units
  double elevation;  // degrees above the floor
  double azimuth;    // degrees, from the direction at right angles to the edge
  double turn;       // degrees of the edge in the shadow map
};
std::ostream& operator<<(std::ostream& out, const View& v) {
  return out << v.distance << " units away, " << v.elevation << " degrees up, " << v.azimuth
             << " aside, edge turned by " << v.turn;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

// At right angles to the edge, towards the light; the edge passes through the origin.
glm::dvec3 outward(const View& v) { return {std::cos(radians(v.turn)), 0, std::sin(radians(v.turn))}; }

// Half of the floor lies in the shadow of a square above it; the light shines straight down.
Scene edge_scene(const View& v) {
  constexpr double kHalf = 4;
  Scene scene;
  analytic::add(scene, analytic::square(8), {0, 0, 0});
  const glm::dvec3 out = outward(v), at = -kHalf * out + glm::dvec3(0, kHeight, 0);
  analytic::add(scene, analytic::square(float(kHalf)), at);
  scene.instances.back().world_from_object =
      glm::translate(glm::dmat4(1), at) * glm::rotate(glm::dmat4(1), -radians(v.turn), glm::dvec3(0, 1, 0));
  const double up = radians(v.elevation), aside = radians(v.azimuth);
  const glm::dvec3 along(-out.z, 0, out.x);
  const glm::dvec3 eye = v.distance * (std::cos(up) * (std::cos(aside) * out + std::sin(aside) * along) +
                                       glm::dvec3(0, std::sin(up), 0));
  scene.cameras.push_back(analytic::camera(eye, {0, 0, 0}));
  scene.lights.push_back(analytic::light(LightType::directional, {0, 9, 0}));
  return scene;
}

struct Ramp {
  double width = 0, offset = 0;  // world units: of the fitted line from 0 to 1, and of where it is 1/2
  double worst = 0;              // largest distance of a pixel from (4.3)
  size_t pixels = 0;
};

// The line through visibility over the signed distance to the edge, well inside the penumbra and far from
// corners.
Ramp fit(const View& v, const Scene& scene, const std::vector<float>& visibility, const Reference& r) {
  const glm::dvec3 eye(scene.cameras[0].world_from_camera[3]), out = outward(v);
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  Ramp ramp;
  for (size_t i = 0; i < visibility.size(); ++i) {
    if (r.domain[0][i] != Reference::counted) continue;
    const glm::dvec3 p = eye + glm::dvec3(r.position[i]);
    if (std::abs(p.y) > 1e-3) continue;  // not the floor
    const double s = glm::dot(p, out), t = glm::length(p - s * out);
    if (std::abs(s) > 0.4 * kPenumbra || t > 1) continue;
    ++n, x += s, y += visibility[i], xx += s * s, xy += s * visibility[i];
    ramp.worst = std::max(ramp.worst, std::abs(visibility[i] - (0.5 + s / kPenumbra)));
  }
  const double slope = (n * xy - x * y) / (n * xx - x * x);
  ramp.width = 1 / slope, ramp.offset = x / n + (0.5 - y / n) / slope, ramp.pixels = size_t(n);
  return ramp;
}

std::vector<float> edtsm(const Scene& scene, Values set) {
  set.insert({{"penumbra", kPenumbra}, {"shadow_map", std::int64_t(2048)}});
  RenderSettings s;
  s.width = kWidth, s.height = kRows;
  return hard_shadow::visibility("edtsm", scene, s, set)[0];
}

class StraightEdge : public testing::TestWithParam<View> {};
INSTANTIATE_TEST_SUITE_P(All, StraightEdge,
                         testing::Values(View{5, 60, 0, 0}, View{10, 60, 0, 0}, View{14, 60, 0, 0},
                                         View{8, 60, 0, 30}, View{8, 60, 40, 75}, View{8, 35, 0, 0},
                                         View{8, 35, 40, 45}, View{8, 35, 70, 10}, View{8, 20, 45, 60},
                                         View{5, 25, 55, 20}),
                         test::ParameterName());

TEST_P(StraightEdge, HasTheWorldSpaceWidthItWasGiven) {
  const View v = GetParam();
  const Scene scene = edge_scene(v);
  const Reference r = hard_shadow::trace(scene, hard_shadow::settings(true, kWidth, kRows));
  for (const double filter : {1.0, 7.0}) {
    const Ramp ramp = fit(v, scene, edtsm(scene, {{"filter", filter}}), r);
    if (std::getenv("GNOMON_TEST_FIGURES"))
      std::printf("%4.0f %4.0f %4.0f %4.0f filter %2.0f: width %.4f offset %+.4f worst %.4f of %zu\n",
                  v.distance, v.elevation, v.azimuth, v.turn, filter, ramp.width, ramp.offset, ramp.worst,
                  ramp.pixels);
    ASSERT_GT(ramp.pixels, 500u) << v;
    EXPECT_NEAR(ramp.width, kPenumbra, 0.03 * kPenumbra) << v << ", filter " << filter;
    EXPECT_NEAR(ramp.offset, 0, 0.03 * kPenumbra) << v << ", filter " << filter;
  }
}

// Every transform serves. Exact ones may choose different sites at the same distance in the image, which lie
// at slightly different ones in the world; jump flooding may miss some.
TEST(Edtsm, TransformsAgree) {
  const Scene scene = edge_scene({8, 60, 40, 75});
  const auto bounded = edtsm(scene, {});
  for (const std::string algorithm : {"banded_exact", "jump_flooding"}) {
    const auto other = edtsm(scene, {{"algorithm", algorithm}});
    size_t differ = 0;
    for (size_t i = 0; i < bounded.size(); ++i) differ += std::abs(bounded[i] - other[i]) > 0.02f;
    EXPECT_LT(differ, bounded.size() / 1000) << algorithm;
  }
}

// A screen-space penumbra is all there, whatever radius the transform was given.
TEST(Edtsm, TheTransformReachesAsFarAsTheScreenSpacePenumbra) {
  const Scene scene = edge_scene({8, 60, 40, 75});
  const Values screen = {
      {"metric", "screen"}, {"pixels", 40.0}, {"penumbra", 0.0}, {"penumbra_relative", 0.0}};
  Values near = screen, far = screen;
  near["radius"] = std::int64_t(1), far["radius"] = std::int64_t(64);
  EXPECT_EQ(edtsm(scene, near), edtsm(scene, far));
}

// Penumbrae of any width, from none to wider than the scene, stay in range and keep umbra and light apart.
TEST(Edtsm, AnyWidthIsFiniteAndInRange) {
  const Scene scene = edge_scene({8, 35, 40, 45});
  for (const double penumbra : {1e-30, 1e-3, 20.0, 1e9})
    for (const float v : edtsm(scene, {{"penumbra", penumbra}})) ASSERT_TRUE(v >= 0 && v <= 1) << penumbra;
}

}  // namespace
}  // namespace gnomon
