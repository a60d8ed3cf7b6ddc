// One frame of a hard-shadow graph on software Vulkan with validation, held against the ray tracer.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/render/renderer.h"
#include "engine/truth/metrics.h"
#include "engine/truth/reference.h"
#include "tests/shaders/gpu_kernel_helper.h"

namespace gnomon::hard_shadow {

struct Frame {
  std::vector<std::vector<float>> visibility;  // [light], row 0 at the top
  std::vector<std::string> warnings;
  std::map<std::string, double> facts;
};

inline std::shared_ptr<Device> device() { return test::kernel_device(); }

// One frame's `visibility`: [light][pixel], row 0 at the top. The layers must be silent.
inline std::vector<std::vector<float>> visibility(const Graph& graph, const Scene& scene,
                                                  const RenderSettings& s) {
  const size_t messages = validation_messages(*device()).size();
  Renderer renderer(device(), std::make_shared<Scene>(scene), graph, s);
  renderer.render(TimingMode::none);
  const Image image = renderer.read("visibility");
  const auto& all = validation_messages(*device());
  for (size_t i = messages; i < all.size(); ++i) ADD_FAILURE() << all[i];
  std::vector<std::vector<float>> planes;
  for (size_t l = 0; l < scene.lights.size(); ++l)
    planes.emplace_back(image.plane(l).begin(), image.plane(l).end());
  return planes;
}
inline std::vector<std::vector<float>> visibility(const std::string& graph, const Scene& scene,
                                                  const RenderSettings& s, const Values& set = {}) {
  return visibility(load_graph(find_graph(graph), set), scene, s);
}

inline RenderSettings settings(bool reversed_z, uint32_t width = 160, uint32_t height = 120) {
  RenderSettings s;
  s.width = width, s.height = height;
  s.reversed_z = reversed_z;
  return s;
}

// Renders two frames: the second must have the first one's bits, every value must be 0 or 1, and the layers
// silent.
inline Frame render(const std::string& graph, const Scene& scene, const RenderSettings& s,
                    const Values& set = {}) {
  const size_t messages = validation_messages(*device()).size();
  Renderer renderer(device(), std::make_shared<Scene>(scene), load_graph(find_graph(graph), set), s);
  renderer.render(TimingMode::none);
  const Image first = renderer.read("visibility");
  renderer.render(TimingMode::none);
  const Image second = renderer.read("visibility");
  Frame run;
  for (size_t light = 0; light < scene.lights.size(); ++light) {
    const std::string name = light == 0 ? "Y" : "light" + std::to_string(light) + ".Y";
    const auto a = first.plane(name), b = second.plane(name);
    run.visibility.emplace_back(a.begin(), a.end());
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << "two frames differ, " << name;
    for (const float v : run.visibility.back())
      if (v != 0.0f && v != 1.0f) {
        ADD_FAILURE() << "visibility " << v;
        break;
      }
  }
  const auto& all = validation_messages(*device());
  for (size_t i = messages; i < all.size(); ++i) ADD_FAILURE() << all[i];
  run.warnings = renderer.warnings();
  run.facts = renderer.facts();
  return run;
}

inline Reference trace(const Scene& scene, const RenderSettings& s) {
  ReferenceSettings r;
  r.width = s.width, r.height = s.height;
  return ReferenceTracer(scene).trace(r);
}

struct Misclassified {
  uint64_t counted = 0, wrong = 0, shadowed = 0;  // pixels; shadowed: of the reference
  double share() const { return counted ? double(wrong) / double(counted) : 1.0; }
};

// Over all lights, the counted pixels only.
inline Misclassified compare(const Frame& run, const Reference& reference) {
  Misclassified e;
  for (size_t light = 0; light < run.visibility.size(); ++light)
    for (size_t i = 0; i < run.visibility[light].size(); ++i) {
      if (reference.domain[light][i] != Reference::counted) continue;
      const bool lit = reference.visibility[light][i] >= 0.5f;
      ++e.counted;
      e.shadowed += !lit;
      e.wrong += lit != (run.visibility[light][i] >= 0.5f);
    }
  return e;
}

}  // namespace gnomon::hard_shadow
