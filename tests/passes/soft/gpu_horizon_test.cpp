// What of a light lies behind the plane of a receiver is dark, whatever the map says: a wall whose plane cuts
// the light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/scene/area_light.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

constexpr double kHeight = 8;   // of the light, which is 2 wide and shines down
constexpr double kCut = 0.6;    // where the wall's plane meets the light's: what is beyond is behind the wall
constexpr double kLean = 0.2;   // the wall's x over its way down
constexpr double kSquare = 6;   // height of the caster
constexpr uint32_t kSide = 96;  // pixels

double wall_at(double y) { return kCut + kLean * (kHeight - y); }

// The wall, and a square whose side at `edge` runs along it.
Scene wall(AreaLight::Shape shape, double edge) {
  Scene scene;
  Mesh mesh = analytic::square(2);
  for (glm::vec3& p : mesh.positions) {  // its x becomes height, from 2 to 5.5
    const double y = 3.75 + 0.875 * p.x;
    p = {float(wall_at(y)), float(y), p.z};
  }
  mesh.bounds = {};
  analytic::finish(mesh);
  Material both;
  both.double_sided = true;
  analytic::add(scene, mesh, {0, 0, 0}, both);
  analytic::add(scene, analytic::square(2), {edge - 2, kSquare, 0}, both);
  analytic::add(scene, analytic::square(0.1f), {0.98, 5.2, 1.12},
                both);  // its shadow falls on the wall's rim
  scene.cameras.push_back(analytic::camera({-3, 3.4, 0.03}, {1.4, 3.75, 0}));
  scene.lights.push_back(analytic::light(LightType::spot, {0, kHeight, 0}));
  AreaLight area;
  area.shape = shape;
  area.width = area.height = 2;
  scene.lights[0].area = area;
  return scene;
}

// Calls `use(pixel, x, y)` for every pixel that shows the wall away from its rim.
template <typename Use>
size_t for_each_place(const Scene& scene, const Use& use) {
  ReferenceSettings r;
  r.width = r.height = kSide;
  const Reference reference = ReferenceTracer(scene).trace(r);
  const glm::dvec3 eye(scene.cameras[0].world_from_camera[3]);
  size_t count = 0;
  for (size_t i = 0; i < reference.depth.size(); ++i) {
    if (reference.domain[0][i] != Reference::counted) continue;
    const glm::dvec3 p = eye + glm::dvec3(reference.position[i]);
    if (std::abs(p.x - wall_at(p.y)) > 1e-3 || p.y > 5.3 || p.z > 0 || p.z < -1) continue;
    use(i, p.x, p.y);
    ++count;
  }
  return count;
}

std::vector<float> visibility(const std::string& graph, const Scene& scene) {
  RenderSettings s;
  s.width = s.height = kSide;
  return hard_shadow::visibility(graph, scene, s)[0];
}

// Far from the caster, whose side is beyond the light's other end.
TEST(GpuHorizon, CutsALightThatNothingElseHides) {
  for (const auto shape : {AreaLight::Shape::rectangle, AreaLight::Shape::disc}) {
    const Scene scene = wall(shape, -1.5);
    const auto is = visibility("pcss", scene);
    const double segment = (std::acos(kCut) - kCut * std::sqrt(1 - kCut * kCut)) / M_PI;
    const double wanted = shape == AreaLight::Shape::rectangle ? 0.5 * (1 + kCut) : 1 - segment;
    EXPECT_GT(for_each_place(scene, [&](size_t i, double, double) { EXPECT_NEAR(is[i], wanted, 1.0 / 256); }),
              250u);
  }
}

// The caster leaves the light from its side's image on; the horizon hides the other end.
TEST(GpuHorizon, IsCountedPointByPoint) {
  constexpr double kEdge = 0.8;
  const Scene scene = wall(AreaLight::Shape::rectangle, kEdge);
  const auto is = visibility("pcss", scene);
  size_t partly = 0;
  for_each_place(scene, [&](size_t i, double x, double y) {
    const double from = std::max(x + (kEdge - x) * (kHeight - y) / (kSquare - y), -1.0);
    const double wanted = std::max(0.5 * (kCut - from), 0.0);
    partly += wanted > 0.02 && wanted < 0.75;
    EXPECT_NEAR(is[i], wanted, 0.03) << x << ' ' << y;
  });
  EXPECT_GT(partly, 50u);
}

}  // namespace
}  // namespace gnomon
