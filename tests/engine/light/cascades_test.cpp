// Cascades: what each of them shows, and how finely.
#include "engine/light/cascades.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/graph/graph_resolve.h"
#include "engine/scene/scene.h"
#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

// A plane of 200 x 200 with a square above it, seen from its border at eye height, under a slanting sun.
Scene plain() {
  Scene scene;
  analytic::add(scene, analytic::square(100), {0, 0, 0});
  analytic::add(scene, analytic::square(1), {0, 3, 60});
  scene.cameras.push_back(analytic::camera({0, 2, 99}, {0, 0, 0}));
  scene.lights.push_back(analytic::light(LightType::directional, {3, 5, 1}));
  return scene;
}

constexpr double kAspect = 1.5;

// Where the view shows a point: (0, 0) to (1, 1) inside of it.
glm::dvec2 place(const LightView& view, const glm::dvec3& p) {
  const glm::dvec4 clip = view.clip_from_light() * view.light_from_world * glm::dvec4(p, 1.0);
  return 0.5 + 0.5 * glm::dvec2(clip) / clip.w;
}
bool shows(const LightView& view, const glm::dvec3& p) {
  const glm::dvec2 at = place(view, p);
  return at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1;
}

// Points of the plane that the camera sees, and their depths.
std::vector<std::pair<glm::dvec3, double>> seen_points(const Scene& scene) {
  const Camera& camera = scene.cameras[0];
  const glm::dmat4 view = glm::inverse(camera.world_from_camera);
  const double y = std::tan(0.5 * camera.fov_y), x = y * kAspect;
  std::vector<std::pair<glm::dvec3, double>> points;
  for (double px = -99.5; px < 100; px += 1)
    for (double pz = -99.5; pz < 100; pz += 1) {
      const glm::dvec3 q(view * glm::dvec4(px, 0, pz, 1));
      const double depth = -q.z;
      if (depth > camera.near && std::abs(q.x) <= x * depth && std::abs(q.y) <= y * depth)
        points.emplace_back(glm::dvec3(px, 0, pz), depth);
    }
  return points;
}

TEST(Cascades, EachShowsAllThatIsInViewAsFarAsItReaches) {
  const Scene scene = plain();
  const LightView whole = light_views(scene, 1024, 0)[0];
  const CascadeSplit split{4, 0.5};
  const std::vector<LightView> views = cascades(scene, scene.cameras[0], kAspect, whole, split);
  ASSERT_EQ(views.size(), 4u);
  double farthest = 0;
  for (const auto& [p, depth] : seen_points(scene)) farthest = std::max(farthest, depth);
  int tested = 0;
  for (const auto& [p, depth] : seen_points(scene))
    for (size_t i = 0; i < 4; ++i) {
      if (depth > farthest * std::pow(0.5, double(3 - i))) continue;
      EXPECT_TRUE(shows(views[i], p)) << "cascade " << i << " at depth " << depth;
      ++tested;
    }
  EXPECT_GT(tested, 10000);
}

TEST(Cascades, NearerOnesAreFinerAndNoneIsCoarserThanTheWhole) {
  const Scene scene = plain();
  const LightView whole = light_views(scene, 1024, 0)[0];
  const std::vector<LightView> views = cascades(scene, scene.cameras[0], kAspect, whole, {4, 0.5});
  for (size_t i = 0; i < views.size(); ++i) {
    const double next = i + 1 < views.size() ? views[i + 1].half_width : whole.half_width;
    EXPECT_LE(views[i].half_width, next * 1.01) << i;
    EXPECT_EQ(views[i].near, whole.near);  // casters on the way to the light are not cut off
    EXPECT_EQ(views[i].far, whole.far);
    EXPECT_TRUE(views[i].orthographic);
  }
  EXPECT_LT(views[0].half_width, 0.25 * whole.half_width);
  // One that reaches as far as the last is the last.
  const std::vector<LightView> one = cascades(scene, scene.cameras[0], kAspect, whole, {1, 0.5});
  EXPECT_EQ(one[0].light_from_world, views[3].light_from_world);
  EXPECT_EQ(one[0].half_width, views[3].half_width);
}

TEST(Cascades, ACameraThatSeesNothingHasTheWholeView) {
  Scene scene = plain();
  scene.cameras[0] = analytic::camera({0, 2, 99}, {0, 50, 200});
  const LightView whole = light_views(scene, 1024, 0)[0];
  for (const LightView& view : cascades(scene, scene.cameras[0], kAspect, whole, {3, 0.5}))
    EXPECT_EQ(view.half_width, whole.half_width);
}

TEST(Cascades, FarOriginGivesTheSameWindows) {
  const glm::dvec3 by(6.4e6, -1e6, 3e6);
  const Scene scene = plain(), far = analytic::moved(scene, by);
  const auto here = cascades(scene, scene.cameras[0], kAspect, light_views(scene, 64, 0)[0], {3, 0.5});
  const auto there = cascades(far, far.cameras[0], kAspect, light_views(far, 64, 0)[0], {3, 0.5});
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(here[i].half_width, there[i].half_width, 1e-6 * here[i].half_width);
    const glm::dvec2 moved = place(there[i], glm::dvec3(1, 0, 90) + by) - place(here[i], {1, 0, 90});
    EXPECT_NEAR(glm::length(moved), 0, 1e-6);
  }
}

std::string error_of(std::vector<LightType> types, int64_t count) {
  const Graph graph = parse_graph(R"({"schema": 1, "name": "c", "passes": [
    {"id": "gbuffer", "type": "gbuffer"}, {"id": "views", "type": "light_views", "params": {"cascades": )" +
                                      std::to_string(count) + R"(}},
    {"id": "map", "type": "shadow_map", "in": {"views": "views.views"}}],
    "outputs": {"map": "map.depth"}})",
                                  "g.json");
  Problems problems;
  const auto lights = uint32_t(types.size());
  Declaration::Setting setting;
  setting.lights = lights;
  setting.light_types = std::move(types);
  const ResolvedGraph resolved = resolve_graph(graph, setting, problems);
  if (!problems.empty()) return problems.all().front().what;
  const Port* map = resolved.nodes[resolved.index.at("map")].declaration.find("depth");
  return std::to_string(map->image.layers) + " layers";
}

TEST(Cascades, TheProducerDecidesHowManyViewsThereAre) {
  using enum LightType;
  EXPECT_EQ(error_of({spot, point, directional}, 1), "8 layers");
  EXPECT_EQ(error_of({directional, directional}, 4), "8 layers");
  EXPECT_EQ(error_of({directional}, 8), "8 layers");
}

TEST(Cascades, SpotAndPointLightsHaveNone) {
  using enum LightType;
  for (const LightType type : {spot, point}) {
    const std::string error = error_of({directional, type}, 4);
    EXPECT_NE(error.find("'cascades' is 4"), std::string::npos) << error;
    EXPECT_NE(error.find("only directional lights have cascades"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace gnomon
