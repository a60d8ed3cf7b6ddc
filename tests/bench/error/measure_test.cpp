// Errors against the reference, per light and over lights, and the shaded reference.
#include "bench/error/measure.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/base/error.h"
#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

using namespace analytic;

constexpr uint32_t width = 80, height = 60;

Reference trace(const Scene& scene) {
  ReferenceSettings settings;
  settings.width = width, settings.height = height;
  return ReferenceTracer(scene).trace(settings);
}

Image perfect(const Reference& r) {
  std::vector<std::string> names = {"Y"};
  for (uint32_t i = 1; i < r.lights; ++i) names.push_back("light" + std::to_string(i) + ".Y");
  Image image(r.width, r.height, names);
  for (uint32_t i = 0; i < r.lights; ++i)
    std::copy(r.visibility[i].begin(), r.visibility[i].end(), image.plane(i).begin());
  return image;
}

Scene two_lights() {
  Scene scene = square_over_plane(light(LightType::spot, {0, 6, 0}));
  scene.lights.push_back(light(LightType::directional, {0.3, 1, -0.2}));
  return scene;
}

TEST(Measure, PerfectVisibilityHasNoError) {
  const Scene scene = two_lights();
  const Reference r = trace(scene);
  const ReferenceTracer tracer(scene);
  const MeasuredError e = measure_visibility(perfect(r), r, {&tracer, scene.cameras[0], 128, 2});
  ASSERT_EQ(e.lights.size(), 2u);
  EXPECT_EQ(e.all.rmse, 0);
  EXPECT_EQ(e.all.misclassified, 0);
  EXPECT_EQ(*e.all.acne, 0);
  EXPECT_EQ(e.all.pixels, e.lights[0].pixels + e.lights[1].pixels);
  EXPECT_EQ(e.all.pixels + e.all.excluded, 2u * width * height);
}

// One light all wrong, one all right: means are half, the largest stays.
TEST(Measure, LightsAreAveraged) {
  const Reference r = trace(two_lights());
  Image image = perfect(r);
  for (float& v : image.plane(1)) v = 1 - v;
  const MeasuredError e = measure_visibility(image, r);
  EXPECT_EQ(e.lights[1].misclassified, 1);
  EXPECT_EQ(e.all.misclassified, 0.5);
  EXPECT_EQ(e.all.max, 1);
  EXPECT_FALSE(e.all.acne);
}

TEST(Measure, LightsThatSeeNothingDoNotCount) {
  Scene scene = two_lights();
  scene.lights[1] = light(LightType::point, {0, -5, 0});  // below the ground
  const Reference r = trace(scene);
  Image image = perfect(r);
  for (float& v : image.plane(0)) v = 1 - v;
  const MeasuredError e = measure_visibility(image, r);
  EXPECT_EQ(e.lights[1].pixels, 0u);
  EXPECT_EQ(e.all.misclassified, 1);
  EXPECT_EQ(e.all.max, 1);
}

TEST(Measure, AcneIsWhatLiesAwayFromEdges) {
  const Scene scene = square_over_plane(light(LightType::spot, {0, 6, 0}));
  const Reference r = trace(scene);
  const ReferenceTracer tracer(scene);
  const EdgeSettings acne{&tracer, scene.cameras[0], 128, 2};
  const glm::dvec3 eye(scene.cameras[0].world_from_camera[3]);
  Image image = perfect(r);
  uint64_t dark = 0, expected = 0, counted = 0;
  for (size_t i = 0; i < image.data.size(); ++i) {
    counted += r.domain[0][i] == Reference::counted;
    const glm::dvec3 p = eye + glm::dvec3(r.position[i]);
    if (std::isinf(r.depth[i]) || p.y > 1 || r.domain[0][i] != Reference::counted || r.visibility[0][i] != 1)
      continue;
    // Distance to the umbra's border at 1.5; a texel is 0.09375: two are 0.1875.
    const double d = std::hypot(std::max(0.0, std::abs(p.x) - 1.5), std::max(0.0, std::abs(p.z) - 1.5));
    if (d > 0.5 || std::abs(d - 0.1875) < 0.03) continue;  // the disc's grid is half a texel fine at corners
    image.data[i] = 0.2f;
    ++dark;
    expected += d > 0.1875;
  }
  ASSERT_GT(expected, 20u);
  ASSERT_GT(dark, expected + 20);
  const MeasuredError e = measure_visibility(image, r, acne);
  EXPECT_DOUBLE_EQ(e.all.wrongly_shadowed, double(dark) / double(counted));
  EXPECT_DOUBLE_EQ(*e.all.acne, double(expected) / double(counted));
}

// Light in the umbra counts as leak only where no edge is near: one pixel in the middle of the shadow, one at
// its border.
TEST(Measure, LeakIsLightDeepInTheUmbra) {
  const Scene scene = square_over_plane(light(LightType::spot, {0, 6, 0}));
  const Reference r = trace(scene);
  const ReferenceTracer tracer(scene);
  const EdgeSettings edges{&tracer, scene.cameras[0], 128, 2, 3};
  const std::vector<std::vector<uint32_t>> deep{deep_umbra(r, 0, edges)};
  ASSERT_FALSE(deep[0].empty());
  std::vector<uint32_t> shallow;
  for (uint32_t i = 0; i < r.visibility[0].size(); ++i)
    if (r.domain[0][i] == Reference::counted && r.visibility[0][i] == 0 &&
        std::find(deep[0].begin(), deep[0].end(), i) == deep[0].end())
      shallow.push_back(i);
  ASSERT_FALSE(shallow.empty());
  Image image = perfect(r);
  image.plane(0)[shallow.front()] = 1;
  EXPECT_EQ(*measure_visibility(image, r, edges, deep).all.leak, 0);
  image.plane(0)[deep[0].front()] = 0.5;
  const ErrorMetrics all = measure_visibility(image, r, edges, deep).all;
  EXPECT_DOUBLE_EQ(*all.leak, 0.5 / static_cast<double>(deep[0].size()));
  EXPECT_DOUBLE_EQ(*all.umbra_light, 1.5 / static_cast<double>(deep[0].size() + shallow.size()));
}

TEST(Measure, NonfiniteReachesTheRow) {
  const Scene scene = two_lights();
  const Reference r = trace(scene);
  const ReferenceTracer tracer(scene);
  Image image = perfect(r);
  image.plane(1)[7] = std::nanf("");
  const MeasuredError e = measure_visibility(image, r, {&tracer, scene.cameras[0], 128, 2});
  EXPECT_EQ(e.all.nonfinite, 1u);
  EXPECT_TRUE(std::isnan(e.all.rmse));
  EXPECT_TRUE(std::isnan(e.all.max));
  EXPECT_TRUE(std::isnan(*e.all.acne));
  const nlohmann::json json = to_json(e);
  EXPECT_TRUE(json.at("rmse").is_null());
  EXPECT_EQ(json.at("nonfinite"), 1);
  EXPECT_EQ(json.at("lights").at(0).at("rmse"), 0.0);
}

TEST(Measure, RowHasTheNamesOfTheDesign) {
  const Scene scene = square_over_plane(light(LightType::spot, {0, 6, 0}));
  const Reference r = trace(scene);
  const ReferenceTracer tracer(scene);
  const EdgeSettings edges{&tracer, scene.cameras[0], 128, 2, 2};
  const std::vector<std::vector<uint32_t>> deep{deep_umbra(r, 0, edges)};
  MeasuredError e = measure_visibility(perfect(r), r, edges, deep);
  e.all.flip = 0.25;
  const nlohmann::json json = to_json(e);
  for (const char* name :
       {"rmse", "mae", "max", "bias", "misclassified", "wrongly_lit", "wrongly_shadowed", "umbra_light",
        "leak", "over_shadow", "acne", "ssim", "flip", "pixels", "excluded", "nonfinite"})
    EXPECT_TRUE(json.contains(name)) << name;
  EXPECT_FALSE(json.contains("penumbra_rmse"));  // hard shadows have none
  ASSERT_EQ(json.at("lights").size(), 1u);       // one shape, however many lights
  EXPECT_EQ(json.at("lights").at(0).at("rmse"), json.at("rmse"));
}

TEST(Measure, WithoutCountedPixelsThereIsAReasonAndNoFigure) {
  Reference r = trace(square_over_plane(light(LightType::spot, {0, 6, 0})));
  for (size_t i = 0; i < r.domain[0].size(); ++i)
    r.domain[0][i] = i < 3 ? Reference::outside_light : Reference::faces_away;
  const MeasuredError e = measure_visibility(perfect(r), r);
  EXPECT_EQ(e.all.pixels, 0u);
  EXPECT_EQ(e.all.reason, e.lights[0].reason);
  EXPECT_EQ(e.all.reason, "no pixel counts: " + std::to_string(r.domain[0].size() - 3) +
                              " face away from the light, 3 lie outside of what it shines on");
  const nlohmann::json json = to_json(e);
  EXPECT_TRUE(json.at("rmse").is_null());
  EXPECT_TRUE(json.at("lights").at(0).at("misclassified").is_null());
  EXPECT_EQ(json.at("reason"), e.all.reason);
}

TEST(Measure, BadInput) {
  const Reference r = trace(two_lights());
  EXPECT_THROW(measure_visibility(Image(width, height, {"Y"}), r), Error);  // the second light is missing
  EXPECT_THROW(measure_visibility(Image(width + 1, height, {"Y", "light1.Y"}), r), Error);
}

// Below a point light of I candela at height h the ground has radiance I / (pi h^2), a texel at distance d
// from the foot I cos(a)^3 / (pi h^2) with cos(a) = h / hypot(h, d); a directional light adds E cos / pi.
TEST(ShadeReference, LambertByHand) {
  Scene scene = two_lights();
  scene.lights[0].type = LightType::point;
  scene.lights[0].intensity = 50;
  scene.lights[0].color = {1, 0.5, 0.25};
  scene.lights[1].intensity = 2;
  scene.materials[0].base_color = {0.5f, 1, 1, 1};
  const Reference r = trace(scene);
  const Image image = shade_reference(scene, scene.cameras[0], r);
  const glm::dvec3 eye(scene.cameras[0].world_from_camera[3]);
  const double cosine = 1 / std::sqrt(0.09 + 1 + 0.04);
  for (size_t i = 0; i < r.depth.size(); ++i) {
    const glm::dvec3 p = eye + glm::dvec3(r.position[i]);
    if (std::isinf(r.depth[i]) || p.y > 1) continue;
    const double point = 50 * 6 / std::pow(std::hypot(p.x, 6.0, p.z), 3) * r.visibility[0][i];
    const double sun = 2 * cosine * r.visibility[1][i];
    EXPECT_NEAR(image.plane(0)[i], 0.5 * (point + sun) / std::numbers::pi, 1e-5);
    EXPECT_NEAR(image.plane(2)[i], (0.25 * point + sun) / std::numbers::pi, 1e-5);
  }
}

// KHR_lights_punctual: between the cones the falloff is the square of a ramp in the cosine; a range fades the
// light out.
TEST(ShadeReference, SpotConeAndRange) {
  Scene scene = square_over_plane(light(LightType::spot, {0, 6, 0}));
  scene.lights[0].inner_cone = 0.3;
  scene.lights[0].outer_cone = 0.7;
  scene.lights[0].range = 10;
  scene.lights[0].intensity = 36 * std::numbers::pi;
  const Reference r = trace(scene);
  const Image image = shade_reference(scene, scene.cameras[0], r);
  const glm::dvec3 eye(scene.cameras[0].world_from_camera[3]);
  int between = 0;
  for (size_t i = 0; i < r.depth.size(); ++i) {
    const glm::dvec3 p = eye + glm::dvec3(r.position[i]);
    if (std::isinf(r.depth[i]) || p.y > 1 || r.visibility[0][i] == 0) continue;
    const double d = std::hypot(p.x, 6.0, p.z), c = 6 / d;
    const double ramp = std::clamp((c - std::cos(0.7)) / (std::cos(0.3) - std::cos(0.7)), 0.0, 1.0);
    EXPECT_NEAR(image.plane(1)[i], std::pow(c, 3) * ramp * ramp * (1 - std::pow(d / 10, 4)) * (d < 10), 1e-5);
    between += ramp > 0 && ramp < 1;
  }
  EXPECT_GT(between, 50);
}

}  // namespace
}  // namespace gnomon
