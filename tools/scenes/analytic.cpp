// The scenes square_plane, sphere_plane and area_shapes, whose shadows have closed forms.
#include <utility>

#include "engine/image/png.h"
#include "engine/scene/area_light.h"
#include "tools/scene_generate.h"
#include "tools/scenes/scenes.h"
#include "tools/scenes/shapes.h"

namespace gnomon::generate {
namespace {

// Row 0 is at the light's +y.
std::string window_png() {
  const std::vector<uint8_t> panes = {255, 200, 120, 255, 0, 0, 0, 255, 0, 0, 0, 255, 120, 200, 255, 255};
  return png::encode(panes, area_shapes::kWindowPanes, area_shapes::kWindowPanes, 4, "window.png");
}

}  // namespace

std::string sphere_plane_scene() {
  namespace s = sphere_plane;
  Builder builder("sphere_plane");
  Shape ground, sphere;
  add_ground(ground, glm::dvec2(s::kGroundHalf), 0.0);
  add_sphere(sphere, {s::kSphereCentre[0], s::kSphereCentre[1], s::kSphereCentre[2]},
             glm::dvec3(s::kSphereRadius), 5);
  builder.add("ground", ground, builder.material({"ground", {0.8, 0.8, 0.8}, true, {}, {}}));
  builder.add("sphere", sphere, builder.material({"sphere", {0.7, 0.3, 0.2}, false, {}, {}}));
  builder.camera({1.0, 6.0, 8.0}, {-0.6, 1.0, 0.0}, 42.0, 0.1);
  const glm::dvec3 light(s::kLight[0], s::kLight[1], s::kLight[2]);
  builder.spot(light, light - glm::dvec3(0, light.y, 0), 80.0, 0.7, s::kLightSide);
  return builder.glb();
}

std::string square_plane_scene() {
  namespace s = square_plane;
  Builder builder("square_plane");
  Shape ground, blocker;
  add_ground(ground, glm::dvec2(s::kGroundHalf), 0.0);
  add_ground(blocker, glm::dvec2(s::kBlockerHalf), s::kBlockerHeight);
  builder.add("ground", ground, builder.material({"ground", {0.8, 0.8, 0.8}, true, {}, {}}));
  builder.add("blocker", blocker, builder.material({"blocker", {0.2, 0.4, 0.7}, true, {}, {}}));
  builder.camera({3.6, 3.2, 4.4}, {0.0, 0.5, 0.0}, 42.0, 0.1);
  builder.spot({0, s::kLightHeight, 0}, {0, 0, 0}, 72.0, 0.7, s::kLightSide);
  return builder.glb();
}

std::string sun_and_lamp_scene() {
  namespace s = sun_and_lamp;
  Builder builder("sun_and_lamp");
  Shape ground, blocker, post;
  add_ground(ground, glm::dvec2(s::kGroundHalf), 0.0);
  add_ground(blocker, glm::dvec2(s::kBlockerHalf), s::kBlockerHeight);
  add_box(post, {-0.5, 1.0, 0.5}, {0.25, 1.0, 0.25});
  builder.add("ground", ground, builder.material({"ground", {0.8, 0.8, 0.8}, true, {}, {}}));
  builder.add("blocker", blocker, builder.material({"blocker", {0.2, 0.4, 0.7}, true, {}, {}}));
  builder.add("post", post, builder.material({"post", {0.7, 0.3, 0.2}, false, {}, {}}));
  builder.camera({2.2, 3.4, 5.0}, {0.5, 0.4, 0.6}, 42.0, 0.1);
  builder.sun({s::kSunDirection[0], s::kSunDirection[1], s::kSunDirection[2]}, 0.5, s::kSunDegrees);
  const glm::dvec3 lamp(s::kLamp[0], s::kLamp[1], s::kLamp[2]);
  builder.lamp(lamp, lamp.y, 0.3, s::kLampRadius);
  return builder.glb();
}

std::string area_shapes_scene() {
  namespace s = area_shapes;
  using Area = AreaLight;
  Builder builder("area_shapes");
  Shape ground, blocker;
  add_ground(ground, glm::dvec2(s::kGroundHalf), 0.0);
  add_ground(blocker, glm::dvec2(s::kBlockerHalf), s::kBlockerHeight);
  builder.add("ground", ground, builder.material({"ground", {0.8, 0.8, 0.8}, true, {}, {}}));
  builder.add("blocker", blocker, builder.material({"blocker", {0.2, 0.4, 0.7}, true, {}, {}}));
  builder.camera({3.6, 5.2, 5.4}, {0.0, 0.2, 0.0}, 48.0, 0.1);
  const uint32_t window = builder.texture("window", window_png(), true);
  std::vector<glm::dvec2> outline;
  for (const auto& p : s::kPolygon) outline.emplace_back(p[0], p[1]);
  const double disc = 2 * s::kDiscRadius, sphere = 2 * s::kSphereRadius, pane = s::kWindowSide;
  const std::pair<const char*, Area> areas[] = {
      {"rectangle", {Area::Shape::rectangle, s::kRectangleWidth, s::kRectangleHeight, {}, {}}},
      {"disc", {Area::Shape::disc, disc, disc, {}, {}}},
      {"sphere", {Area::Shape::sphere, sphere, sphere, {}, {}}},
      {"polygon", polygon_light(outline)},
      {"window", {Area::Shape::rectangle, pane, pane, {}, window}}};
  for (size_t i = 0; i < std::size(areas); ++i) {
    const glm::dvec3 place(s::kLights[i][0], 0, s::kLights[i][1]), up(0, s::kLightHeight, 0);
    builder.area_spot(areas[i].first, place + up, place, 84.0, 0.15, areas[i].second);
  }
  return builder.glb();
}

}  // namespace gnomon::generate
