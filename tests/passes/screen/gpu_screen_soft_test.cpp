// Soft shadows on the screen, held against the closed form of a half plane.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/passes/soft/half_plane.h"

namespace gnomon {
namespace {

using namespace half_plane_test;

struct Case {
  const char *graph, *form;
  // Of visibility: a pixel of this image is a tenth of the penumbra; a Gaussian is no box, by 0.06.
  double tolerance;
};
void PrintTo(const Case& c, std::ostream* os) { *os << c.graph << ' ' << c.form; }

class ScreenSoftShadow : public testing::TestWithParam<Case> {
 protected:
  static Values form() { return {{"form", std::string(GetParam().form)}}; }
};
INSTANTIATE_TEST_SUITE_P(All, ScreenSoftShadow,
                         testing::Values(Case{"sspcss", "plane", 0.1}, Case{"ssrbssm", "plane", 0.1},
                                         Case{"ssabss", "plane", 0.16}, Case{"ssrbssm", "separable", 0.12}),
                         [](const auto& info) {
                           return std::string(info.param.graph) + "_" + info.param.form;
                         });

TEST_P(ScreenSoftShadow, OfAHalfPlaneIsTheShareOfTheLight) {
  constexpr double kLight = 1;
  const Scene scene = half_plane(area(AreaLight::Shape::rectangle, kLight, kLight));
  const Frame frame = render(scene, form(), GetParam().graph);
  size_t partly = 0;
  for (const Place& p : places(scene)) {
    const double wanted = rectangle_share(p.position.x, kLight);
    ASSERT_NEAR(frame.visibility[p.pixel], wanted, GetParam().tolerance) << p.position.x;
    if (wanted < 0.1 || wanted > 0.9) continue;
    ++partly;
    ASSERT_NEAR(frame.blocker[p.pixel], kBlocker, 1e-2) << p.position.x;
  }
  EXPECT_GT(partly, 200u);
}

TEST_P(ScreenSoftShadow, WidthGoesWithTheLight) {
  const Frame one = render(half_plane(area(AreaLight::Shape::disc, 0.25, 0.25)), form(), GetParam().graph);
  const Frame two = render(half_plane(area(AreaLight::Shape::disc, 0.5, 0.5)), form(), GetParam().graph);
  size_t both = 0;
  for (size_t i = 0; i < one.width.size(); ++i) {
    if (one.width[i] == 0 || two.width[i] == 0) continue;
    ++both;
    ASSERT_NEAR(two.width[i], 2 * one.width[i], 1e-3 * two.width[i]);
  }
  EXPECT_GT(both, 100u);
}

// Lights from nothing to larger than the scene: finite, in [0, 1].
TEST_P(ScreenSoftShadow, StaysInRangeForAnyLight) {
  for (const double size : {1e-6, 0.01, 3.0, 100.0, 1e6}) {
    const Frame frame =
        render(half_plane(area(AreaLight::Shape::disc, size, size)), form(), GetParam().graph);
    for (const float v : frame.visibility) ASSERT_TRUE(v >= 0 && v <= 1) << size << ' ' << v;
    for (const float v : frame.width) ASSERT_TRUE(std::isfinite(v) && v >= 0) << size << ' ' << v;
  }
}

TEST_P(ScreenSoftShadow, UmbraIsDark) {
  const Scene scene = half_plane(area(AreaLight::Shape::rectangle, 0.3, 0.3));
  const Frame frame = render(scene, form(), GetParam().graph);
  for (const Place& p : places(scene)) {
    if (p.position.x > -0.4) continue;  // beyond the Gaussian's cut-off
    ASSERT_EQ(frame.visibility[p.pixel], 0.0f) << p.position.x;
  }
}

}  // namespace
}  // namespace gnomon
