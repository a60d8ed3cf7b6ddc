// The reference depends on what is near, and takes any scene: far geometry, thin gaps, surfaces edge-on to
// the light, and sizes beyond what can be represented.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "engine/base/error.h"
#include "engine/render/gpu_scene.h"
#include "engine/truth/reference.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/engine/truth/far_scenes.h"

namespace gnomon {
namespace {

using namespace analytic;

constexpr uint32_t width = 160, height = 120;

Reference trace(const Scene& scene, uint32_t samples = 0) {
  ReferenceSettings settings;
  settings.width = width, settings.height = height, settings.samples = samples;
  return ReferenceTracer(scene).trace(settings);
}

// Pixels that showed geometry show the same.
void expect_same_where_geometry_was(const Reference& was, const Reference& is) {
  int shown = 0, shadowed = 0;
  for (size_t i = 0; i < was.depth.size(); ++i) {
    if (std::isinf(was.depth[i])) continue;
    ++shown;
    shadowed += was.domain[0][i] == Reference::counted && was.visibility[0][i] == 0;
    EXPECT_EQ(is.depth[i], was.depth[i]);
    EXPECT_EQ(is.domain[0][i], was.domain[0][i]);
    EXPECT_EQ(is.visibility[0][i], was.visibility[0][i]);
  }
  EXPECT_GT(shown, 1000);
  EXPECT_GT(shadowed, 100);
}

TEST(FarGeometry, DomesChangeNothingWithin) {
  const Reference none = trace(plate_scene());
  for (const float radius : {1e2f, 1e3f, 2e4f, 1e6f, 1e8f}) {
    SCOPED_TRACE(radius);
    Scene scene = plate_scene();
    add(scene, dome(radius), {0, 0, 0});
    expect_same_where_geometry_was(none, trace(scene));
  }
}

TEST(FarGeometry, StrayTrianglesChangeNothing) {
  const Reference none = trace(plate_scene());
  for (const glm::vec3 at : {glm::vec3(1e8f, 0, 0), {0, 1e8f, -1e8f}, {-3e5f, -1e7f, 2e6f}}) {
    Scene scene = plate_scene();
    add(scene, triangle(at, at + glm::vec3(1000, 0, 0), at + glm::vec3(0, 1000, 500)), {0, 0, 0});
    expect_same_where_geometry_was(none, trace(scene));
  }
}

TEST(FarGeometry, AreaLightsToo) {
  Scene scene = plate_scene();
  scene.lights[0] = light(LightType::spot, {0.03, 0.2, -0.02});
  scene.lights[0].area = AreaLight{AreaLight::Shape::rectangle, 0.05, 0.04, {}, {}};
  const Reference none = trace(scene, 32);
  add(scene, dome(1e8f), {0, 0, 0});
  expect_same_where_geometry_was(none, trace(scene, 32));
}

// A plate of 2 cm, 1 mm above a ground of 100 m, in a light that comes in at 45 degrees: the shadow is the
// plate moved by 1 mm, and the light reaches under its near edge.
TEST(FarGeometry, AGapOfAMillimetreIsSeen) {
  constexpr double half = 0.01, gap = 0.001;
  Scene scene;
  add(scene, square(50), {0, 0, 0});
  add(scene, square(float(half)), {0, gap, 0});
  scene.cameras.push_back(camera({-0.03, 0.0025, 0.001}, {0, 0, 0}));
  scene.cameras[0].near = 0.001;
  scene.cameras[0].fov_y = 0.3;
  scene.lights.push_back(light(LightType::directional, {-1, 1, 0}));
  const Reference r = trace(scene);
  int under = 0, dark = 0;
  for (size_t i = 0; i < r.depth.size(); ++i) {
    const glm::dvec3 p = glm::dvec3(scene.cameras[0].world_from_camera[3]) + glm::dvec3(r.position[i]);
    if (std::isinf(r.depth[i]) || std::abs(p.y) > 1e-5 || std::abs(p.x) > 0.03) continue;
    const double outside = std::max(std::abs(p.x - gap), std::abs(p.z)) - half;
    if (std::abs(outside) < 1e-5) continue;
    EXPECT_EQ(r.visibility[0][i], outside > 0 ? 1.0f : 0.0f) << p.x << ' ' << p.z;
    under += outside > 0 && std::abs(p.x) < half && std::abs(p.z) < half;
    dark += outside < 0;
  }
  EXPECT_GT(under, 20);
  EXPECT_GT(dark, 200);
}

// The camera's place is where positions are exact: also of the second one, far from the first.
TEST(FarGeometry, EveryCameraIsExactWhereItIs) {
  const Reference near = trace(plate_scene());
  Scene scene = moved(plate_scene(), {3e6, 1e6, -2e6});
  scene.cameras.insert(scene.cameras.begin(), camera({1, 1, 1}, {0, 0, 0}));
  ReferenceSettings settings;
  settings.width = width, settings.height = height, settings.camera = 1;
  const ReferenceTracer tracer(scene);
  (void)tracer.trace({.width = 4, .height = 4});
  const Reference far = tracer.trace(settings);
  int differing = 0;
  for (size_t i = 0; i < near.depth.size(); ++i) differing += near.visibility[0][i] != far.visibility[0][i];
  EXPECT_LE(differing, 4);  // the scene's coordinates are rounded to 5e-10 there
}

// A wall at right angles to the ground, under a sun that stands straight above, turned about its own axis.
TEST(EdgeOn, TheSunsRollDoesNotMatter) {
  std::optional<Reference> first;
  for (int roll = 0; roll < 12; ++roll) {
    const double angle = roll * std::numbers::pi / 6 + 0.1;
    Scene scene;
    add(scene, square(5), {0, 0, 0});
    Mesh wall = square(2);
    for (glm::vec3& p : wall.positions) p = {p.x, p.z, 0};
    wall.normals.assign(4, {0, 0, 1});
    finish(wall);
    Material both;
    both.double_sided = true;
    add(scene, wall, {0, 0, 0}, both);
    scene.cameras.push_back(camera({1, 3, 6}, {0, 0.5, 0}));
    Light sun = light(LightType::directional, {0, 1, 0});
    sun.world_from_light = frame({0, 1, 0}, {0, 0, 0}, {std::cos(angle), 0, std::sin(angle)});
    scene.lights.push_back(sun);
    const Reference r = trace(scene);
    if (!first) {
      first = r;
      EXPECT_GT(std::count(r.domain[0].begin(), r.domain[0].end(), Reference::edge_on), 500);
    }
    EXPECT_EQ(r.domain, first->domain);
    EXPECT_EQ(r.visibility, first->visibility);
  }
}

glm::dvec3 octahedral_decoded(const glm::i16vec2& stored) {
  const glm::dvec2 p = glm::dvec2(stored) / 32767.0;
  glm::dvec3 n(p, 1 - std::abs(p.x) - std::abs(p.y));
  if (n.z < 0) {
    n.x = (1 - std::abs(p.y)) * (p.x >= 0 ? 1 : -1);
    n.y = (1 - std::abs(p.x)) * (p.y >= 0 ? 1 : -1);
  }
  return glm::normalize(n);
}

// The G-buffer's normal is rounded twice. The threshold is above what that may change, and not much.
TEST(EdgeOn, TheThresholdIsThePrecisionOfNormals) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double largest = 0;
  for (int i = 0; i < 1000000; ++i) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    largest = std::max(largest, glm::length(n - octahedral_decoded(octahedral_snorm16(glm::vec3(n)))));
  }
  EXPECT_LT(2 * largest, Reference::least_facing);
  EXPECT_GT(4 * largest, Reference::least_facing);
}

TEST(Unrepresentable, LightsOfAnySizeAndPlaceAreTraced) {
  for (const double size : {1e15, 1e19, 1e38, 1e300}) {
    Scene scene = square_over_plane(light(LightType::spot, {0.25, 6, -0.5}));
    scene.lights[0].area = AreaLight{AreaLight::Shape::rectangle, size, size, {}, {}};
    const Reference r = trace(scene, 16);
    for (const float v : r.visibility[0]) EXPECT_TRUE(v >= 0 && v <= 1);
    Scene far = square_over_plane(light(LightType::point, {0, size, 0}));
    EXPECT_NO_THROW(trace(far));
  }
}

TEST(Unrepresentable, ScenesAreRefused) {
  Scene scene = square_over_plane(light(LightType::point, {0, 6, 0}));
  scene.instances[1].world_from_object = glm::scale(glm::dmat4(1.0), glm::dvec3(1e20));
  EXPECT_THROW(trace(scene), Error);
}

TEST(Unrepresentable, CamerasSeeNothing) {
  Scene scene = square_over_plane(light(LightType::point, {0, 6, 0}));
  scene.cameras[0].aspect = 1e30;
  const Reference r = trace(scene);
  EXPECT_EQ(r.domain[0][0], Reference::no_geometry);
}

}  // namespace
}  // namespace gnomon
