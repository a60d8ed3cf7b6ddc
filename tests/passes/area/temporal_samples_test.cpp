// The points of an area light that one frame after the other takes.
#include "passes/area/temporal_samples.h"

#include <gtest/gtest.h>

#include "engine/scene/area_light.h"
#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

Scene lit_by(const std::optional<AreaLight>& area) {
  Light light = analytic::light(LightType::spot, {0, 6, 0});
  light.area = area;
  return analytic::square_over_plane(light);
}

AreaLight light_of(AreaLight::Shape shape) {
  AreaLight area;
  area.shape = shape;
  area.width = area.height = 1.5;
  return area;
}

TEST(LightSequence, IsTheSequenceOfAreaPoints) {
  for (const AreaLight& area : {light_of(AreaLight::Shape::rectangle), light_of(AreaLight::Shape::disc),
                                polygon_light({{-0.9, -0.5}, {0.9, -0.5}, {0.0, 0.8}})}) {
    const Scene scene = lit_by(area);
    LightSequence sequence(scene, 0);
    const auto points = area_points(area, 40, AreaPattern::sobol, 0);
    for (const uint32_t i : {0, 1, 2, 2, 7, 39, 0, 5})  // on, again, ahead, and back
      EXPECT_EQ(sequence.at(scene, i).local, points[i]) << i;
    EXPECT_EQ(sequence.at(scene, 3).weight, 1.0);
  }
}

TEST(LightSequence, ALightWithoutAreaHasItsCentreAlone) {
  const Scene scene = lit_by({});
  LightSequence sequence(scene, 0);
  for (const uint32_t i : {0, 1, 9}) EXPECT_EQ(sequence.at(scene, i).local, glm::dvec2(0.0));
}

TEST(LightSequence, OnlyPointsThatShineAreTakenAndWeighedByTheLightsMean) {
  AreaLight area = light_of(AreaLight::Shape::rectangle);
  area.emission = 0;
  Scene scene = lit_by(area);
  Texture half;  // its left column is black
  half.width = 2, half.height = 1, half.nearest = true;
  half.rgba = {0, 0, 0, 255, 255, 255, 255, 255};
  scene.textures.push_back(half);
  LightSequence sequence(scene, 0);
  for (uint32_t i = 0; i < 32; ++i) {
    const LightPoint point = sequence.at(scene, i);
    EXPECT_GE(point.local.x, 0.0);
    EXPECT_NEAR(point.weight, 2.0, 1e-12);  // the mean is one half
  }
}

TEST(LightSequence, ALightThatNowhereShinesStillHasPoints) {
  AreaLight area = light_of(AreaLight::Shape::rectangle);
  area.emission = 0;
  Scene scene = lit_by(area);
  Texture black;
  black.rgba = {0, 0, 0, 255};
  scene.textures.push_back(black);
  LightSequence sequence(scene, 0);
  EXPECT_EQ(sequence.at(scene, 3).weight, 1.0);
}

}  // namespace
}  // namespace gnomon
