// What is far away does not make a shadow map useless: it still resolves a plate of 2 cm.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/engine/truth/far_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using namespace analytic;

class FarAway : public testing::TestWithParam<const char*> {
 protected:
  // Every pixel that showed geometry shows the same.
  void expect_same(const Scene& none, const Scene& with) const {
    const RenderSettings s = hard_shadow::settings(true);
    Values set;
    if (load_graph(find_graph(GetParam())).vars.contains("shadow_map")) set["shadow_map"] = int64_t{512};
    const auto was = hard_shadow::visibility(GetParam(), none, s, set)[0];
    const auto is = hard_shadow::visibility(GetParam(), with, s, set)[0];
    const Reference r = hard_shadow::trace(none, s);
    int differing = 0, shadowed = 0;
    for (size_t i = 0; i < was.size(); ++i) {
      if (r.domain[0][i] == Reference::no_geometry) continue;
      differing += was[i] != is[i];
      shadowed += is[i] < 0.5f;
    }
    EXPECT_EQ(differing, 0);
    EXPECT_GT(shadowed, 100);
  }
};

TEST_P(FarAway, Domes) {
  for (const LightType type : {LightType::spot, LightType::point})
    for (const float radius : {1e3f, 1e6f, 1e8f}) {
      SCOPED_TRACE(std::string(name_of(type)) + " " + std::to_string(radius));
      Scene scene = plate_scene(type);
      add(scene, dome(radius), {0, 0, 0});
      expect_same(plate_scene(type), scene);
    }
}

TEST_P(FarAway, StrayTriangles) {
  for (const LightType type : {LightType::point, LightType::directional})
    for (const glm::vec3 at : {glm::vec3(1e8f, 0, 0), {0, -1e3f, 0}, {-3e5f, -1e7f, 2e6f}}) {
      SCOPED_TRACE(name_of(type));
      Scene scene = plate_scene(type);
      add(scene, triangle(at, at + glm::vec3(200, 0, 0), at + glm::vec3(0, 200, 100)), {0, 0, 0});
      expect_same(plate_scene(type), scene);
    }
}

INSTANTIATE_TEST_SUITE_P(Graphs, FarAway,
                         testing::Values("shadow_mapping", "rbsm_nonconservative", "shadow_volumes"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace gnomon
