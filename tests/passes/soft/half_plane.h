// A floor and, over half of it, a blocker parallel to it, under an area light: soft shadows with a closed
// form.
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

namespace gnomon::half_plane_test {

inline constexpr uint32_t kWidth = 128, kHeight = 96;
inline constexpr double kReceiver = 8, kBlocker = 4;  // depths from the light, which is at height 8

inline AreaLight area(AreaLight::Shape shape, double width, double height) {
  AreaLight area;
  area.shape = shape;
  area.width = width;
  area.height = height;
  return area;
}

// A floor at height 0 and, over its half x < 0, a blocker parallel to it; the light above the edge.
inline Scene half_plane(const AreaLight& size, double map_fov = 0.5 * M_PI) {
  Scene scene;
  analytic::add(scene, analytic::square(12), {0, 0, 0});
  analytic::add(scene, analytic::square(6), {-6, kReceiver - kBlocker, 0});
  scene.cameras.push_back(analytic::camera({1.5, 3, 0.02}, {0.3, 0, 0}));
  scene.lights.push_back(analytic::light(LightType::spot, {0, kReceiver, 0}));
  scene.lights[0].map_fov = map_fov;
  scene.lights[0].area = size;
  return scene;
}

struct Frame {
  std::vector<float> visibility, blocker, width;
};

// A graph whose pass `search` finds blockers.
inline Frame render(const Scene& scene, const Values& set = {}, const std::string& graph = "pcss") {
  RenderSettings s;
  s.width = kWidth, s.height = kHeight;
  s.captures = {"search.blocker", "search.width"};
  const auto device = hard_shadow::device();
  const size_t messages = validation_messages(*device).size();
  Renderer renderer(device, std::make_shared<Scene>(scene), load_graph(find_graph(graph), set), s);
  renderer.render(TimingMode::none);
  const auto& all = validation_messages(*device);
  for (size_t i = messages; i < all.size(); ++i) ADD_FAILURE() << all[i];
  const auto plane = [&](const char* name) {
    const Image image = renderer.read(name);
    return std::vector<float>(image.plane(0).begin(), image.plane(0).end());
  };
  return {plane("visibility"), plane("search.blocker"), plane("search.width")};
}

// Where each pixel's receiver is, for those that count.
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

// Of the penumbra.
inline double penumbra(double light) { return light * (kReceiver - kBlocker) / kBlocker; }

// The share of a light of width w that a half plane leaves; of a disc the segment.
inline double rectangle_share(double x, double w) { return std::clamp(0.5 + x / penumbra(w), 0.0, 1.0); }
inline double disc_share(double x, double w) {
  const double d = std::clamp(x / (0.5 * penumbra(w)), -1.0, 1.0);
  return 1 - (std::acos(d) - d * std::sqrt(1 - d * d)) / M_PI;
}

}  // namespace gnomon::half_plane_test
