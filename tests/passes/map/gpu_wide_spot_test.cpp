// Spot lights whose cone no square frustum holds have a point light's views, and no pixel of theirs is left
// out.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "engine/scene/wide_spot.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using namespace analytic;

Scene lit_by(LightType type) {
  Light lamp = light(type, {0.3, 3, -0.2}, {0.3, 0, -0.2});
  lamp.inner_cone = 0;
  lamp.outer_cone = 0.5 * std::numbers::pi;
  lamp.map_fov = kWidestMap;
  return square_over_plane(lamp);
}

class WideSpot : public testing::TestWithParam<const char*> {};

TEST_P(WideSpot, HasThePointLightsShadows) {
  const RenderSettings s = hard_shadow::settings(true);
  const auto spot =
      hard_shadow::visibility(GetParam(), lit_by(LightType::spot), s, {{"shadow_map", int64_t{256}}});
  const auto point =
      hard_shadow::visibility(GetParam(), lit_by(LightType::point), s, {{"shadow_map", int64_t{256}}});
  EXPECT_EQ(spot, point);
  EXPECT_GT(std::count(spot[0].begin(), spot[0].end(), 0.0f), 100);
}
INSTANTIATE_TEST_SUITE_P(Graphs, WideSpot, testing::Values("shadow_mapping", "rbsm_nonconservative", "pcf"),
                         [](const auto& info) { return std::string(info.param); });

TEST(WideSpotReference, CountsEveryPixelThatFacesIt) {
  const RenderSettings s = hard_shadow::settings(true);
  const Reference r = hard_shadow::trace(lit_by(LightType::spot), s);
  EXPECT_EQ(std::count(r.domain[0].begin(), r.domain[0].end(), Reference::outside_light), 0);
  EXPECT_GT(std::count(r.domain[0].begin(), r.domain[0].end(), Reference::counted), 5000);
}

}  // namespace
}  // namespace gnomon
