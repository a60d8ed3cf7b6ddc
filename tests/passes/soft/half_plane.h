// A floor and, over half of it, a blocker parallel to it, under an area light: soft shadows with a closed
// form.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "engine/graph/graph.h"
#include "tests/passes/hard/hard_shadow_run.h"
#include "tests/passes/soft/soft_scenes.h"

namespace gnomon::half_plane_test {

using namespace soft_scenes;

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

}  // namespace gnomon::half_plane_test
