// Soft shadows from summed-area tables, held against the closed form of a half plane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/base/error.h"
#include "tests/passes/soft/half_plane.h"

namespace gnomon {
namespace {

using namespace half_plane_test;

struct Case {
  const char* graph;
  double tolerance;  // of visibility
  double depth;      // of the blocker's depth, world units
};
void PrintTo(const Case& c, std::ostream* os) { *os << c.graph; }

class MomentSoftShadow : public testing::TestWithParam<Case> {};
// Variances and moments of two depths are exact, up to the least variance and the moments' bias. The other
// two bases are blurred in depth: an exponent of 24, and 8 terms of a series, which overshoots by 9 %
// (Gibbs), doubled.
INSTANTIATE_TEST_SUITE_P(All, MomentSoftShadow,
                         testing::Values(Case{"vssm", 1.0 / 64, 0.1}, Case{"mssm", 1.0 / 32, 0.15},
                                         Case{"essm", 1.0 / 16, 0.3}, Case{"cssm", 0.18, 0.6}),
                         [](const auto& info) { return std::string(info.param.graph); });

TEST_P(MomentSoftShadow, OfAHalfPlaneIsTheShareOfTheLight) {
  constexpr double kLight = 1;
  const Scene scene = half_plane(area(AreaLight::Shape::rectangle, kLight, kLight));
  const Frame frame = render(scene, {}, GetParam().graph);
  size_t partly = 0;
  for (const Place& p : places(scene)) {
    const double wanted = rectangle_share(p.position.x, kLight);
    ASSERT_NEAR(frame.visibility[p.pixel], wanted, GetParam().tolerance) << p.position.x;
    if (wanted < 0.1 || wanted > 0.9) continue;
    ++partly;
    ASSERT_NEAR(frame.blocker[p.pixel], kBlocker, GetParam().depth) << p.position.x;
  }
  EXPECT_GT(partly, 200u);
}

TEST_P(MomentSoftShadow, WidthIsThatOfTheBlocker) {
  const Scene scene = half_plane(area(AreaLight::Shape::disc, 0.5, 0.5));
  const Frame frame = render(scene, {}, GetParam().graph);
  for (const Place& p : places(scene)) {
    if (frame.blocker[p.pixel] == 0) {
      EXPECT_EQ(frame.width[p.pixel], 0.0f);
      continue;
    }
    const double blocker = frame.blocker[p.pixel];
    EXPECT_NEAR(frame.width[p.pixel], 0.5 * (kReceiver - blocker) / blocker, 1e-3);
  }
}

// Lights from nothing to larger than the scene: finite, in [0, 1].
TEST_P(MomentSoftShadow, StaysInRangeForAnyLight) {
  for (const double size : {1e-6, 0.01, 3.0, 100.0, 1e6}) {
    const Frame frame = render(half_plane(area(AreaLight::Shape::disc, size, size)), {}, GetParam().graph);
    for (const float v : frame.visibility) ASSERT_TRUE(v >= 0 && v <= 1) << size << ' ' << v;
    for (const float v : frame.width) ASSERT_TRUE(std::isfinite(v) && v >= 0) << size << ' ' << v;
    for (const float v : frame.blocker) ASSERT_TRUE(std::isfinite(v) && v >= 0) << size << ' ' << v;
  }
}

// Deep in the umbra the pyramid decides: no moments leak.
TEST_P(MomentSoftShadow, UmbraIsDark) {
  const Scene scene = half_plane(area(AreaLight::Shape::rectangle, 0.3, 0.3));
  const Frame frame = render(scene, {}, GetParam().graph);
  for (const Place& p : places(scene)) {
    if (p.position.x > -0.3) continue;  // twice the penumbra's half
    ASSERT_EQ(frame.visibility[p.pixel], 0.0f) << p.position.x;
  }
}

TEST(MomentBlocker, RefusesBasesThatTellNoDepth) {
  const std::string graph = R"({ "schema": 1, "name": "test", "passes": [
    { "id": "gbuffer", "type": "gbuffer" }, { "id": "views", "type": "light_views" },
    { "id": "map", "type": "shadow_map", "from": "views" },
    { "id": "pyramid", "type": "min_max_pyramid", "in": { "shadow_map": "map.depth" } },
    { "id": "moments", "type": "shadow_moments", "in": { "shadow_map": "map.depth" }, "params": { "basis": "exponential" } },
    { "id": "table", "type": "summed_area_table", "in": { "source": "moments.moments" } },
    { "id": "search", "type": "moment_blocker", "in": { "shadow_map": "map.depth", "moments": "table.sums" }, "from": ["gbuffer", "pyramid"] },
    { "id": "test", "type": "moment_test", "in": { "shadow_map": "map.depth", "moments": "table.sums" }, "from": ["gbuffer", "search"] } ],
    "outputs": { "visibility": "test.visibility" } })";
  const Scene scene = half_plane(area(AreaLight::Shape::disc, 1, 1));
  try {
    hard_shadow::visibility(parse_graph(graph, "test"), scene, RenderSettings{});
    FAIL() << "was not refused";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("tells no depth"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace gnomon
