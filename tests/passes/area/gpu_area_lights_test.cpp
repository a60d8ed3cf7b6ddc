// Area lights sampled by point lights: against closed forms, the ray tracer, and each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/area_light.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

using hard_shadow::device;
using hard_shadow::settings;

constexpr double kLightHeight = 6, kLightSide = 1;

AreaLight square_light(double side) {
  AreaLight area;
  area.width = area.height = side;
  return area;
}

// A square light straight above a square blocker and a plane, all parallel.
Scene overhead(const AreaLight& area) {
  Light light = analytic::light(LightType::spot, {0, kLightHeight, 0});
  light.area = area;
  return analytic::square_over_plane(light);
}

// Share of the light that a point of the plane sees: the blocker, projected from the point to the light's
// plane, is a square, and covers a rectangle of the light.
double visible_share(double x, double z) {
  const double scale = kLightHeight / analytic::blocker_height;
  const auto covered = [&](double at) {
    const double centre = at - at * scale, half = analytic::blocker_half * scale;
    const double low = std::max(centre - half, -0.5 * kLightSide),
                 high = std::min(centre + half, 0.5 * kLightSide);
    return std::max(high - low, 0.0) / kLightSide;
  };
  return 1 - covered(x) * covered(z);
}

struct Sampled {
  std::vector<float> first, second;  // visibility of light 0 after one and two frames
  std::map<std::string, double> facts, second_facts;
  std::vector<std::string> warnings;
};

Sampled sample(const std::string& graph, const Scene& scene, const RenderSettings& s, const Values& set = {},
               bool again = true) {
  const size_t messages = validation_messages(*device()).size();
  Renderer renderer(device(), std::make_shared<Scene>(scene), load_graph(find_graph(graph), set), s);
  Sampled result;
  const auto read = [&] {
    const Image image = renderer.read("visibility");
    return std::vector<float>(image.plane(size_t{0}).begin(), image.plane(size_t{0}).end());
  };
  renderer.render(TimingMode::none);
  result.first = read();
  result.facts = renderer.facts();
  if (again) renderer.render(TimingMode::overlapped);
  result.second = read();
  result.second_facts = renderer.facts();
  result.warnings = renderer.warnings();
  for (const float v : result.first) EXPECT_TRUE(v >= 0.0f && v <= 1.0f) << v;
  const auto& all = validation_messages(*device());
  for (size_t i = messages; i < all.size(); ++i) ADD_FAILURE() << all[i];
  return result;
}

double rmse(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / double(a.size()));
}

// Over pixels of the plane, seen past the blocker.
double rmse_to_closed_form(const std::vector<float>& v, const Scene& scene, const RenderSettings& s) {
  const Reference reference = hard_shadow::trace(scene, s);
  const glm::dvec3 eye(scene.cameras[0].world_from_camera[3]);
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < v.size(); ++i) {
    const glm::dvec3 p = glm::dvec3(reference.position[i]) + eye;
    if (reference.domain[0][i] != Reference::counted || std::abs(p.y) > 1e-3) continue;
    const double difference = v[i] - visible_share(p.x, p.z);
    sum += difference * difference;
    ++count;
  }
  EXPECT_GT(count, 5000u);
  return std::sqrt(sum / double(count));
}

// Sampling error of n points: the penumbra of a separable blocker is a product of two steps; a stratified
// estimate errs by at most about 1/sqrt(n) a side, and the map's texels add theirs.
TEST(AreaLights, PenumbraOfASquareHasTheClosedForm) {
  const Scene scene = overhead(square_light(kLightSide));
  const RenderSettings s = settings(true);
  const Sampled result =
      sample("area_uniform", scene, s,
             {{"samples", int64_t{4096}}, {"pattern", "sobol"}, {"shadow_map", int64_t{512}}}, false);
  EXPECT_EQ(result.facts.at("light.light_samples"), 4096);
  EXPECT_LT(rmse_to_closed_form(result.first, scene, s), 0.006);
}

TEST(AreaLights, ErrorFallsWithTheNumberOfSamples) {
  const Scene scene = overhead(square_light(kLightSide));
  const RenderSettings s = settings(true);
  double before = 1;
  for (const int64_t n : {4, 16, 64}) {
    const Sampled result = sample("area_uniform", scene, s, {{"samples", n}, {"pattern", "sobol"}}, false);
    const double error = rmse_to_closed_form(result.first, scene, s);
    EXPECT_LT(error, 0.75 * before) << n;
    before = error;
  }
}

// Seen from near, so that the penumbra is many pixels wide: refinement asks what the camera sees.
TEST(AreaLights, AdaptiveSamplingReachesTheClosedFormWithFewerSamples) {
  Scene scene = overhead(square_light(kLightSide));
  scene.cameras[0] = analytic::camera({2.6, 1.6, 2.6}, {1.2, 0, 1.2});
  const RenderSettings s = settings(true, 480, 360);
  const double uniform = rmse_to_closed_form(sample("area_uniform", scene, s).first, scene, s);
  const Sampled rb = sample("area_adaptive_rb", scene, s);
  EXPECT_LT(rmse_to_closed_form(rb.first, scene, s), 1.3 * uniform);
  EXPECT_LT(rb.facts.at("refine.light_samples"), 289);
  EXPECT_EQ(rb.first, rb.second);
  EXPECT_LE(rb.facts.at("refine.host_waits"), rb.facts.at("refine.levels") + 1) << "one wait a level";
}

TEST(AreaLights, BothOrdersOfRefinementSelectTheSameSamples) {
  const Scene scene = overhead(square_light(2.5));
  const RenderSettings s = settings(true);
  const Sampled breadth = sample("area_adaptive_rb", scene, s, {{"levels", int64_t{3}}});
  const Sampled depth =
      sample("area_adaptive_rb", scene, s, {{"levels", int64_t{3}}, {"order", "depth_first"}});
  EXPECT_EQ(breadth.facts.at("refine.light_samples"), depth.facts.at("refine.light_samples"));
  EXPECT_GT(depth.facts.at("refine.host_waits"), breadth.facts.at("refine.host_waits"));
  for (size_t i = 0; i < breadth.first.size(); ++i) ASSERT_NEAR(breadth.first[i], depth.first[i], 1e-5) << i;
}

TEST(AreaLights, UnderTheSameWindowRevectorizationNeverTakesMoreSamples) {
  for (const double side : {0.3, 1.0, 2.5}) {
    const Scene scene = overhead(square_light(side));
    const Values windows = {{"window_1", int64_t{1}}, {"window_2", int64_t{2}}, {"window_4", int64_t{4}}};
    const Sampled rb = sample("area_adaptive_rb", scene, settings(true), windows);
    const Sampled plain = sample("area_adaptive", scene, settings(true), windows);
    EXPECT_LE(rb.facts.at("refine.light_samples"), plain.facts.at("refine.light_samples")) << side;
  }
}

TEST(AreaLights, MoreSoftDiscontinuitiesAskedMeanMoreSamples) {
  const Scene scene = overhead(square_light(2.5));
  double before = 0;
  for (const int64_t sd : {0, 1, 2, 3, 4}) {
    const Sampled result = sample("area_adaptive_rb", scene, settings(true), {{"soft_discontinuity", sd}});
    EXPECT_GE(result.facts.at("refine.light_samples"), before) << sd;
    before = result.facts.at("refine.light_samples");
    if (sd == 0) {
      EXPECT_EQ(before, 4) << "every pixel counts as smooth";
    }
  }
}

TEST(AreaLights, WithoutPenumbraInViewRefinementEndsAtLevelZero) {
  Scene scene = overhead(square_light(kLightSide));
  scene.instances.pop_back();  // the blocker
  RenderSettings s = settings(true);
  s.keep_all = true;  // the maps that this scene does not need, too
  const Sampled result = sample("area_adaptive_rb", scene, s);
  EXPECT_EQ(result.facts.at("refine.light_samples"), 4);
  EXPECT_EQ(result.facts.at("refine.levels"), 0);
  EXPECT_EQ(result.facts.at("refine.host_waits"), 1);
}

// Of two lights one has no caster: all of the technique would be left out otherwise.
TEST(AreaLights, ReceiversThatNoCasterReachesCostNoMaps) {
  Scene scene = overhead(square_light(kLightSide));
  scene.lights.push_back(analytic::light(LightType::spot, {30, 3, 30}, {60, 0, 60}));
  scene.lights.back().area = square_light(kLightSide);
  scene.lights.back().map_fov = 0.5;
  const Sampled both = sample("area_uniform", scene, settings(true));
  const Sampled rb = sample("area_adaptive_rb", scene, settings(true));
  RenderSettings all = settings(true);
  all.keep_all = true;
  const Sampled uniform_all = sample("area_uniform", scene, all),
                rb_all = sample("area_adaptive_rb", scene, all);
  EXPECT_EQ(both.facts.at("light.maps_rendered"), 0.5 * uniform_all.facts.at("light.maps_rendered"));
  EXPECT_LT(rb.facts.at("refine.maps_rendered"), rb_all.facts.at("refine.maps_rendered"));
  EXPECT_EQ(both.first, uniform_all.first);
  EXPECT_EQ(rb.first, rb_all.first);
}

TEST(AreaLights, ALightWithoutAreaIsTheHardTechnique) {
  Light light = analytic::light(LightType::spot, {2, 6, 1});
  for (const LightType type : {LightType::spot, LightType::point, LightType::directional}) {
    light.type = type;
    const Scene scene = analytic::square_over_plane(light);
    const RenderSettings s = settings(true);
    const Sampled uniform = sample("area_uniform", scene, s), rb = sample("area_adaptive_rb", scene, s);
    EXPECT_EQ(uniform.facts.at("light.light_samples"), type == LightType::point ? 6 : 1);
    EXPECT_EQ(rb.facts.at("refine.light_samples"), 1);
    const auto hard = hard_shadow::visibility("shadow_mapping", scene, s)[0];
    const auto filtered = hard_shadow::visibility("rbsm_filtered", scene, s)[0];
    constexpr double kRounding = 0.002;  // a byte's, and pixels on a texel's border
    EXPECT_LT(rmse(uniform.first, hard), 0.01);
    EXPECT_LT(rmse(rb.first, filtered), 0.01 + kRounding);
  }
}

TEST(AreaLights, ShadowMapsNeverTakeMoreThanTheMemoryLimit) {
  const Scene scene = overhead(square_light(kLightSide));
  RenderSettings plenty = settings(true), little = settings(true);
  little.memory = 3 * 1024 * 1024 * 4;  // three maps
  const Sampled all = sample("area_uniform", scene, plenty), few = sample("area_uniform", scene, little);
  EXPECT_EQ(all.first, few.first);
}

TEST(AreaLights, RefinementStopsAndSaysSoWhereMemoryEnds) {
  Scene scene = overhead(square_light(2.5));
  scene.cameras[0] = analytic::camera({2.6, 1.6, 2.6}, {1.2, 0, 1.2});
  RenderSettings little = settings(true, 240, 180);
  little.memory = 4 * 1024 * 1024;
  const Sampled result = sample("area_adaptive_rb", scene, little,
                                {{"shadow_map", int64_t{256}}, {"soft_discontinuity", int64_t{4}}});
  EXPECT_EQ(result.facts.at("refine.lights_cut_by_memory"), 1);
  EXPECT_GT(result.facts.at("refine.light_samples"), 9);
}

TEST(AreaLights, UnchangedLightsAndCastersKeepTheirMaps) {
  const Scene scene = overhead(square_light(kLightSide));
  const Values set = {{"samples", int64_t{25}}, {"cache", true}, {"shadow_map", int64_t{256}}};
  const Sampled kept = sample("area_uniform", scene, settings(true), set);
  EXPECT_EQ(kept.facts.at("light.maps_rendered"), 25);
  EXPECT_EQ(kept.second_facts.at("light.maps_rendered"), 0);
  EXPECT_EQ(kept.first, kept.second);
  RenderSettings little = settings(true);
  little.memory = 10 * 256 * 256 * 4;
  const Sampled cannot = sample("area_uniform", scene, little, set);
  EXPECT_EQ(cannot.second_facts.at("light.maps_rendered"), 25);
  EXPECT_EQ(cannot.first, kept.first);
  EXPECT_FALSE(cannot.warnings.empty());
}

TEST(AreaLights, RefinementKeepsMapsToo) {
  const Scene scene = overhead(square_light(2.5));
  const Values plain = {{"shadow_map", int64_t{256}}}, set = {{"shadow_map", int64_t{256}}, {"cache", true}};
  const Sampled kept = sample("area_adaptive_rb", scene, settings(true), set);
  EXPECT_EQ(kept.facts.at("refine.maps_rendered"), kept.facts.at("refine.light_samples"));
  EXPECT_EQ(kept.second_facts.at("refine.maps_rendered"), 0);
  EXPECT_EQ(kept.first, kept.second);
  EXPECT_EQ(kept.first, sample("area_adaptive_rb", scene, settings(true), plain).first);
}

// Error of a graph against the ray tracer, over counted pixels of all lights.
double error_to_rays(const std::string& graph, Scene scene, const Values& set) {
  scene.cameras[0] = analytic::camera({2.6, 1.6, 2.6}, {1.2, 0, 1.2});
  const RenderSettings s = settings(true, 160, 120);
  ReferenceSettings r;
  r.width = s.width, r.height = s.height, r.samples = 400;
  const Reference reference = ReferenceTracer(scene).trace(r);
  const auto v = hard_shadow::visibility(graph, scene, s, set);
  double sum = 0, count = 0;
  for (size_t light = 0; light < v.size(); ++light)
    for (size_t i = 0; i < v[light].size(); ++i) {
      if (reference.domain[light][i] != Reference::counted) continue;
      const double difference = v[light][i] - reference.visibility[light][i];
      sum += difference * difference, ++count;
    }
  return std::sqrt(sum / count);
}

TEST(AreaLights, ShapesFollowTheRayTracer) {
  AreaLight disc = square_light(1.5);
  disc.shape = AreaLight::Shape::disc;
  AreaLight sphere = disc;
  sphere.shape = AreaLight::Shape::sphere;
  const AreaLight polygon = polygon_light({{-0.9, -0.5}, {0.9, -0.5}, {0.0, 0.8}});
  for (const AreaLight& area : {disc, sphere, polygon}) {
    const Scene scene = overhead(area);
    EXPECT_LT(error_to_rays("area_uniform", scene,
                            {{"samples", int64_t{144}}, {"pattern", "sobol"}, {"shadow_map", int64_t{512}}}),
              0.02)
        << int(area.shape);
    EXPECT_LT(error_to_rays("area_adaptive_rb", scene, {{"soft_discontinuity", int64_t{4}}}), 0.03)
        << int(area.shape);
  }
}

TEST(AreaLights, ATexturedLightIsWeighedByItsEmission) {
  AreaLight area = square_light(1.5);
  area.emission = 0;
  Scene scene = overhead(area);
  Texture half;  // its left column is black
  half.width = 2, half.height = 1, half.nearest = true;
  half.rgba = {0, 0, 0, 255, 255, 255, 255, 255};
  scene.textures.push_back(half);
  EXPECT_LT(
      error_to_rays("area_uniform", scene,
                    {{"samples", int64_t{144}}, {"pattern", "grid_centres"}, {"shadow_map", int64_t{512}}}),
      0.02);
  EXPECT_LT(error_to_rays("area_adaptive_rb", scene, {{"soft_discontinuity", int64_t{4}}}), 0.04);
}

TEST(AreaLights, SeveralLightsAreSampledSideBySide) {
  Scene scene = overhead(square_light(kLightSide));
  Light second = analytic::light(LightType::spot, {3, 6, 2});
  second.area = square_light(1.5);
  scene.lights.push_back(second);
  scene.lights.push_back(analytic::light(LightType::directional, {1, 3, 0}));
  EXPECT_LT(error_to_rays("area_uniform", scene,
                          {{"samples", int64_t{144}}, {"pattern", "sobol"}, {"shadow_map", int64_t{512}}}),
            0.045);
  EXPECT_LT(error_to_rays("area_adaptive_rb", scene, {}), 0.045);
}

}  // namespace
}  // namespace gnomon
