// Planar shadows against closed forms and the ray tracer.
#include <glm/gtc/matrix_transform.hpp>

#include "passes/volume/receiver_planes.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/parameter_name.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using namespace hard_shadow;
using analytic::add;
using analytic::light;
using analytic::square;

const glm::dvec3 kLightAt(1.5, 7, 1);
constexpr double kBound = 5e-4;  // share of the counted pixels: those that a true edge passes within rounding

Scene turned(Scene scene, const glm::dmat4& by) {
  for (Instance& i : scene.instances) i.world_from_object = by * i.world_from_object;
  for (Camera& c : scene.cameras) c.world_from_camera = by * c.world_from_camera;
  for (Light& l : scene.lights) l.world_from_light = by * l.world_from_light;
  scene.bounds = {};
  for (const Instance& i : scene.instances)
    for (const glm::vec3& p : scene.meshes[i.mesh].positions)
      scene.bounds.add(glm::dvec3(i.world_from_object * glm::dvec4(p, 1.0)));
  return scene;
}

void expect_error(const Scene& scene, const RenderSettings& s, const char* what) {
  const Misclassified e = compare(render("planar_shadows", scene, s), trace(scene, s));
  EXPECT_GT(e.counted, 1000u) << what;
  EXPECT_GT(e.shadowed, 0u) << what;
  EXPECT_LE(e.share(), kBound) << what << ": " << e.wrong << " of " << e.counted;
}

struct Case {
  LightType type;
  bool reversed_z;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << analytic::name_of(c.type) << (c.reversed_z ? " reversed" : " standard");
}
class PlanarShadowsCase : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, PlanarShadowsCase,
                         testing::Values(Case{LightType::spot, true}, Case{LightType::spot, false},
                                         Case{LightType::point, true}, Case{LightType::point, false},
                                         Case{LightType::directional, true},
                                         Case{LightType::directional, false}),
                         test::ParameterName());

// The shadow of the square at height h on the plane y = 0 is the square itself, moved and scaled from the
// light.
TEST_P(PlanarShadowsCase, SquareHasItsClosedForm) {
  const Scene scene = analytic::square_over_plane(light(GetParam().type, kLightAt));
  const RenderSettings s = settings(GetParam().reversed_z);
  const Frame run = render("planar_shadows", scene, s);
  const Reference seen = trace(scene, s);  // for the pixels' positions alone
  const glm::dvec3 eye(scene.cameras[0].world_from_camera[3]);
  size_t tested = 0, dark = 0, wrong = 0;
  for (size_t i = 0; i < seen.depth.size(); ++i) {
    if (!std::isfinite(seen.depth[i])) continue;
    const glm::dvec3 p = glm::dvec3(seen.position[i]) + eye;
    if (std::abs(p.y) > 0.1) continue;
    const glm::dvec3 l = GetParam().type == LightType::directional ? kLightAt : kLightAt - p;
    const glm::dvec3 at = p + l * ((analytic::blocker_height - p.y) / l.y);
    const double outside = std::max(std::abs(at.x), std::abs(at.z)) - analytic::blocker_half;
    if (std::abs(outside) < 1e-4) continue;  // the edge itself
    ++tested;
    dark += outside < 0;
    wrong += run.visibility[0][i] != (outside < 0 ? 0.0f : 1.0f);
  }
  EXPECT_GT(tested, 5000u);
  EXPECT_GT(dark, 50u);
  EXPECT_EQ(wrong, 0u);
}

TEST_P(PlanarShadowsCase, SphereOverTiltedPlanes) {
  Scene scene;
  add(scene, square(20), {0, 0, 0});
  add(scene, analytic::sphere(1, 24, 48), {0, 2, 0});
  scene.cameras.push_back(analytic::camera({6, 8, 7}, {0, 0, 0}));
  scene.lights.push_back(light(GetParam().type, kLightAt));
  for (const double angle : {0.0, 0.7, 2.5}) {
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), angle, glm::normalize(glm::dvec3(1, 2, -1.5)));
    // One receiver: the sphere's own facets then are none.
    const Scene now = turned(scene, turn);
    const RenderSettings s = settings(GetParam().reversed_z);
    const Frame run = render("planar_shadows", now, s, {{"planes", int64_t(1)}});
    const Misclassified e = compare(run, trace(now, s));
    EXPECT_GT(e.shadowed, 50u);
    EXPECT_LE(e.share(), kBound) << "turned by " << angle << ": " << e.wrong << " of " << e.counted;
  }
}

// A floor and a wall that stand on each other, and a blocker: each receives the others' shadows, and none its
// own.
TEST_P(PlanarShadowsCase, FloorAndWall) {
  Scene scene;
  add(scene, square(6), {0, 0, 0});
  add(scene, square(3), {0, 0, 0});
  scene.instances[1].world_from_object =
      glm::translate(glm::dmat4(1.0), glm::dvec3(-3, 3, 0)) *
      glm::rotate(glm::dmat4(1.0), -1.5707963267948966, glm::dvec3(0, 0, 1));
  add(scene, square(0.7f), {-0.5, 1.5, 0});
  scene = turned(scene, glm::dmat4(1.0));
  scene.cameras.push_back(analytic::camera({7, 5, 6}, {0, 1, 0}));
  scene.lights.push_back(light(GetParam().type, {3, 4, 1.5}, {-1, 1, 0}));
  expect_error(scene, settings(GetParam().reversed_z), "floor and wall");
}

// Casters beyond the light, and behind the receiver, cast nothing on it: no anti-shadow.
TEST_P(PlanarShadowsCase, NoAntiShadow) {
  Scene scene;
  add(scene, square(20), {0, 0, 0});
  add(scene, square(1), {0.2, 6, 0.1});   // the light is below it
  add(scene, square(2), {0.3, -1, 0.2});  // beneath the receiver
  Mesh leaning = square(1);               // reaches from beneath the receiver to beyond the light
  leaning.positions = {{3, -1, -1}, {3, -1, 1}, {3.5, 8, 1}, {3.5, 8, -1}};
  leaning.bounds = {};
  analytic::finish(leaning);
  add(scene, leaning, {0, 0, 0});
  scene.cameras.push_back(analytic::camera({-5, 9, 7}, {0, 0, 0}));
  scene.lights.push_back(light(GetParam().type, {0.5, 4, 0.25}));
  const RenderSettings s = settings(GetParam().reversed_z);
  const Frame run = render("planar_shadows", scene, s, {{"planes", int64_t(1)}});
  const Reference reference = trace(scene, s);
  size_t counted = 0, wrong = 0;
  for (size_t i = 0; i < reference.depth.size(); ++i) {
    const bool floor = reference.domain[0][i] == Reference::counted && reference.normal[i].y > 0.999f &&
                       std::abs(reference.position[i].y + 9.0f) < 0.1f;
    counted += floor;
    wrong += floor && reference.visibility[0][i] != run.visibility[0][i];
  }
  EXPECT_GT(counted, 3000u);
  EXPECT_LE(double(wrong), kBound * double(counted));
}

TEST(PlanarShadows, LitFromBelow) {
  Scene scene = analytic::square_over_plane(light(LightType::point, {1, -3, 0.5}));
  scene.instances[1].world_from_object = glm::translate(glm::dmat4(1.0), glm::dvec3(0, -1, 0));
  for (Material& m : scene.materials) m.double_sided = true;
  scene.cameras[0] = analytic::camera({5, -7, 6}, {0, 0, 0});
  scene = turned(scene, glm::dmat4(1.0));
  expect_error(scene, settings(true), "from below");
}

TEST(PlanarShadows, FarFromTheOrigin) {
  const Scene scene =
      analytic::moved(analytic::square_over_plane(light(LightType::spot, kLightAt)), {1e5, -2e5, 5e4});
  expect_error(scene, settings(true), "moved by 2e5");
}

// Holes of an alpha mask let light through: half of the blocker's texture is empty.
TEST(PlanarShadows, AlphaMask) {
  Scene scene = analytic::square_over_plane(light(LightType::point, kLightAt));
  Texture texture;
  texture.width = 2, texture.height = 1, texture.nearest = true;
  texture.rgba = {255, 255, 255, 255, 255, 255, 255, 0};
  scene.textures.push_back(texture);
  scene.materials[1].base_color_texture = 0;
  scene.materials[1].alpha_masked = true;
  expect_error(scene, settings(true), "masked");
}

TEST(PlanarShadows, SeveralLightsInTheirLayers) {
  Scene scene = analytic::square_over_plane(light(LightType::spot, kLightAt));
  scene.lights.push_back(light(LightType::directional, {-3, 5, 2}));
  scene.lights.push_back(light(LightType::point, {-4, 4, -3}));
  expect_error(scene, settings(true), "three lights");
}

TEST(ReceiverPlanes, LargestFirstWhicheverWayTheyFace) {
  Scene scene;
  add(scene, square(2), {0, 1, 0});
  add(scene, square(3, false), {9, 0, 0});
  add(scene, square(2.5), {-9, 0, 0});  // coplanar with the second
  add(scene, analytic::sphere(0.5, 8, 16), {0, 3, 0});
  const auto planes = receiver_planes(scene, 2);
  ASSERT_EQ(planes.size(), 2u);
  EXPECT_NEAR(planes[0].area, 36 + 25, 1e-6);
  EXPECT_NEAR(planes[1].area, 16, 1e-6);
  EXPECT_NEAR(std::abs(planes[0].plane.y), 1, 1e-12);
  EXPECT_NEAR(planes[0].plane.w, 0, 1e-6);
  EXPECT_NEAR(planes[1].plane.w / planes[1].plane.y, -1, 1e-6);
  EXPECT_TRUE(receiver_planes(Scene{}, 4).empty());
}

}  // namespace
}  // namespace gnomon
