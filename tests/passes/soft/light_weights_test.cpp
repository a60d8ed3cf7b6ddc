// Weights of a light's points: of its shape, of its texture.
#include "passes/soft/light_weights.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "engine/scene/area_light.h"
#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

Scene lit_by(AreaLight::Shape shape) {
  Scene scene;
  scene.lights.push_back(analytic::light(LightType::spot, {0, 8, 0}));
  scene.lights[0].area = AreaLight{};
  scene.lights[0].area->shape = shape;
  scene.lights[0].area->width = 2, scene.lights[0].area->height = 1;
  return scene;
}

// Sum of the weights of the points that `rows`, a bit a row, and `columns` are of.
double sum(const LightWeights& weights, uint32_t rows, uint32_t columns) {
  double total = 0;
  for (uint32_t plane = 0; plane < LightWeights::kPlanes; ++plane)
    for (uint32_t row = 0; row < 16; ++row) {
      const uint32_t bits =
          weights.planes[plane][row % LightWeights::kWords] >> (row / LightWeights::kWords * 16);
      if ((rows >> row & 1) != 0)
        total += std::popcount(bits & columns & 0xFFFFu) * std::ldexp(1.0, int(plane));
    }
  return total;
}
constexpr uint32_t kAll = 0xFFFF;

TEST(LightWeights, OfARectangleAreAllTheSame) {
  const LightWeights weights = light_weights(lit_by(AreaLight::Shape::rectangle), 0);
  EXPECT_EQ(weights.total, 256u * 255u);
  EXPECT_EQ(sum(weights, kAll, kAll), weights.total);
  EXPECT_EQ(sum(weights, 1, 1), 255);
}

TEST(LightWeights, OfADiscAreItsShareOfEachCell) {
  const LightWeights weights = light_weights(lit_by(AreaLight::Shape::disc), 0);
  EXPECT_EQ(sum(weights, kAll, kAll), weights.total);
  EXPECT_NEAR(weights.total / (256.0 * 255), M_PI / 4, 0.01);
  EXPECT_EQ(sum(weights, 1, 1), 0);  // a corner
  EXPECT_NEAR(sum(weights, 0xFF, kAll), 0.5 * weights.total, 0.01 * weights.total);
  EXPECT_NEAR(sum(weights, kAll, 0xFF), 0.5 * weights.total, 0.01 * weights.total);
}

// Row 0 of a texture is at +y, which is up in a map, and column 0 at -x.
TEST(LightWeights, OfATextureAreItsEmission) {
  Scene scene = lit_by(AreaLight::Shape::rectangle);
  Texture corner;
  corner.width = corner.height = 2, corner.nearest = true;
  corner.rgba.assign(16, 0);
  corner.rgba[0] = corner.rgba[1] = corner.rgba[2] = 255;
  scene.textures.push_back(corner);
  scene.lights[0].area->emission = 0;
  const LightWeights weights = light_weights(scene, 0);
  EXPECT_GT(weights.total, 0u);
  // Points stand a quarter of a cell beside its middle, and so does what they count for.
  EXPECT_NEAR(sum(weights, 0xFF, 0xFF), weights.total, 0.04 * weights.total);
}

TEST(LightWeights, OfALightWithoutAreaAreThere) {
  Scene scene = lit_by(AreaLight::Shape::rectangle);
  scene.lights[0].area.reset();
  EXPECT_EQ(light_weights(scene, 0).total, 256u * 255u);
}

}  // namespace
}  // namespace gnomon
