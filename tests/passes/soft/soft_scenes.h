// Soft shadows that have closed forms: a floor under a light straight above, and what hides it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "engine/graph/graph.h"
#include "engine/scene/area_light.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon::soft_scenes {

constexpr uint32_t kWidth = 128, kHeight = 96;
constexpr double kReceiver = 8, kBlocker = 4;  // depths from the light, which is at height 8

inline AreaLight area(AreaLight::Shape shape, double width, double height) {
  AreaLight area;
  area.shape = shape;
  area.width = width;
  area.height = height;
  return area;
}

// A floor at height 0 and nothing else.
inline Scene floor_under(const AreaLight& size, double map_fov = 0.5 * M_PI) {
  Scene scene;
  analytic::add(scene, analytic::square(12), {0, 0, 0});
  scene.cameras.push_back(analytic::camera({1.5, 3, 0.02}, {0.3, 0, 0}));
  scene.lights.push_back(analytic::light(LightType::spot, {0, kReceiver, 0}));
  scene.lights[0].map_fov = map_fov;
  scene.lights[0].area = size;
  return scene;
}
// The same and, over its half x < 0, a blocker parallel to it; the light above the edge.
inline Scene half_plane(const AreaLight& size, double map_fov = 0.5 * M_PI) {
  Scene scene = floor_under(size, map_fov);
  analytic::add(scene, analytic::square(6), {-6, kReceiver - kBlocker, 0});
  return scene;
}

inline std::vector<float> render(const std::string& graph, const Scene& scene, const Values& set,
                                 bool keep_all) {
  RenderSettings s;
  s.width = kWidth, s.height = kHeight;
  s.keep_all = keep_all;
  return hard_shadow::visibility(graph, scene, s, set)[0];
}

// Where each pixel's receiver is, for those on the floor that count.
struct Place {
  size_t pixel;
  glm::dvec3 position;
};
inline std::vector<Place> places(const Scene& scene) {
  ReferenceSettings r;
  r.width = kWidth, r.height = kHeight;
  const Reference reference = ReferenceTracer(scene).trace(r);
  const glm::dvec3 eye(scene.cameras[0].world_from_camera[3]);
  std::vector<Place> all;
  for (size_t i = 0; i < reference.depth.size(); ++i) {
    if (reference.domain[0][i] != Reference::counted) continue;
    const glm::dvec3 p = eye + glm::dvec3(reference.position[i]);
    if (std::abs(p.y) < 1e-3) all.push_back({i, p});
  }
  return all;
}

inline double penumbra(double light) { return light * (kReceiver - kBlocker) / kBlocker; }

// The share of a light of width w that the half plane leaves at x; of a disc the segment.
inline double rectangle_share(double x, double w) { return std::clamp(0.5 + x / penumbra(w), 0.0, 1.0); }
inline double disc_share(double x, double w) {
  const double d = std::clamp(x / (0.5 * penumbra(w)), -1.0, 1.0);
  return 1 - (std::acos(d) - d * std::sqrt(1 - d * d)) / M_PI;
}

// Holds the floor's pixels against `share` of their position; returns how many are in the penumbra
// (`partly`) or how many there are.
template <typename Share>
size_t expect_shares(const std::vector<float>& visibility, const Scene& scene, const Share& share,
                     double tolerance, bool partly = true) {
  size_t count = 0;
  double worst = 0;
  glm::dvec3 where(0);
  for (const Place& p : places(scene)) {
    const double wanted = share(p.position), error = std::abs(double(visibility[p.pixel]) - wanted);
    if (error > worst || std::isnan(error)) worst = error, where = p.position;
    count += !partly || (wanted > 0 && wanted < 1);
  }
  EXPECT_LE(worst, tolerance + 1e-4) << "at " << where.x << ", " << where.z << " wanted " << share(where);
  return count;
}

}  // namespace gnomon::soft_scenes
