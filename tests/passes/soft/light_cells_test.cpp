// Weights of a light's parts: all alike, by shape, by texture.
#include "passes/soft/light_cells.h"

#include <gtest/gtest.h>

#include "engine/scene/area_light.h"

namespace gnomon {
namespace {

Light light_of(const AreaLight& area) {
  Light light;
  light.type = LightType::spot;
  light.area = area;
  return light;
}

AreaLight rectangle() {
  AreaLight area;
  area.shape = AreaLight::Shape::rectangle;
  area.width = area.height = 2;
  return area;
}

TEST(LightCells, AreAlikeOnARectangleAndADisc) {
  AreaLight disc = rectangle();
  disc.shape = AreaLight::Shape::disc;
  for (const AreaLight& area : {rectangle(), disc}) {
    EXPECT_FALSE(has_uneven_cells(light_of(area)));
    for (const float cell : light_cells(Scene(), light_of(area))) EXPECT_EQ(cell, 1.0f);
  }
}

// The lower left triangle: rows go down, columns to the right.
TEST(LightCells, OfAPolygonAreWhatItCovers) {
  const Light light = light_of(polygon_light({{-1, -1}, {1, -1}, {-1, 1}}));
  ASSERT_TRUE(has_uneven_cells(light));
  const auto cells = light_cells(Scene(), light);
  for (uint32_t row = 0; row < kLightCells; ++row)
    for (uint32_t column = 0; column < kLightCells; ++column) {
      const float cell = cells[row * kLightCells + column];
      if (column < row) {
        EXPECT_EQ(cell, 1.0f) << row << ' ' << column;
      } else if (column > row) {
        EXPECT_EQ(cell, 0.0f) << row << ' ' << column;
      } else {
        EXPECT_NEAR(cell, 0.5f, 0.1f);
      }
    }
}

TEST(LightCells, OfATextureAreItsEmission) {
  Scene scene;
  Texture texture;  // the upper right quarter shines
  texture.width = texture.height = 2, texture.nearest = true;
  texture.rgba.assign(16, 0);
  for (size_t i = 4; i < 8; ++i) texture.rgba[i] = 255;
  scene.textures.push_back(texture);
  AreaLight area = rectangle();
  area.emission = 0;
  const auto cells = light_cells(scene, light_of(area));
  for (uint32_t row = 0; row < kLightCells; ++row)
    for (uint32_t column = 0; column < kLightCells; ++column)
      EXPECT_NEAR(cells[row * kLightCells + column], row < 8 && column >= 8 ? 1 : 0, 1e-5);
}

}  // namespace
}  // namespace gnomon
