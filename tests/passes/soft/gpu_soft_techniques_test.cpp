// RBSSM and EDTSSM, held against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/scene/area_light.h"
#include "tests/passes/soft/soft_scenes.h"

namespace gnomon {
namespace {

using namespace soft_scenes;

struct Technique {
  const char* graph;
  AreaLight::Shape shape;
  double tolerance;  // beside a straight edge
};

class SoftTechnique : public testing::TestWithParam<Technique> {
 public:
  static Scene scene(double width) { return half_plane(area(GetParam().shape, width, width)); }
  static std::vector<float> render(const Scene& scene, const Values& set = {}, bool keep_all = false) {
    return soft_scenes::render(GetParam().graph, scene, set, keep_all);
  }
};
// RBSSM: its taps meet the edge in 81 steps. EDTSSM: the line through the cracks between pixels about the
// silhouette is that of the edge up to a part of a pixel, of which the penumbra has 15; to it a light is as
// wide as a rectangle.
INSTANTIATE_TEST_SUITE_P(All, SoftTechnique,
                         testing::Values(Technique{"rbssm", AreaLight::Shape::rectangle, 1.0 / 24},
                                         Technique{"rbssm", AreaLight::Shape::disc, 1.0 / 16},
                                         Technique{"edtssm", AreaLight::Shape::rectangle, 1.0 / 16}),
                         [](const auto& info) {
                           const bool disc = info.param.shape == AreaLight::Shape::disc;
                           return std::string(info.param.graph) + (disc ? "_disc" : "");
                         });

TEST_P(SoftTechnique, OfAHalfPlaneIsTheShareOfTheLight) {
  const auto share = GetParam().shape == AreaLight::Shape::disc ? disc_share : rectangle_share;
  for (const double width : {0.5, 1.0}) {
    const Scene half = scene(width);
    EXPECT_GT(
        expect_shares(
            render(half), half, [&](const glm::dvec3& p) { return share(p.x, width); }, GetParam().tolerance),
        200u)
        << width;
  }
}

TEST_P(SoftTechnique, IsTheSameThroughOtherMaps) {
  const Scene half = scene(1);
  const auto standard = render(half);
  const auto expect_same = [&](const std::vector<float>& other, const char* what) {
    double most = 0;
    for (const Place& p : places(half))
      most = std::max(most, double(std::abs(other[p.pixel] - standard[p.pixel])));
    EXPECT_LE(most, 1.5 * GetParam().tolerance) << what;  // both are wrong by up to that
  };
  expect_same(render(half, {{"depth", std::string("linear")}}), "linear depth");
  expect_same(render(half, {{"shadow_map", std::int64_t(2048)}}), "2048");
  expect_same(render(half_plane(*half.lights[0].area, 2.0)), "field of view");
}

TEST_P(SoftTechnique, WorkingOnEveryPixelChangesNothing) {
  const Scene half = scene(0.7);
  EXPECT_EQ(render(half), render(half, {}, true));
}

TEST_P(SoftTechnique, StaysInRangeForAnyLight) {
  for (const double size : {1e-6, 0.01, 3.0, 100.0, 1e6})
    for (const float v : render(scene(size))) ASSERT_TRUE(v >= 0 && v <= 1) << size << ' ' << v;
}

}  // namespace
}  // namespace gnomon
