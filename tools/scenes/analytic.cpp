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
  return png::encode(panes, area_shapes::window_panes, area_shapes::window_panes, 4, "window.png");
}

}  // namespace

std::string sphere_plane_scene() {
  namespace s = sphere_plane;
  Builder builder("sphere_plane");
  Shape ground, sphere;
  add_ground(ground, glm::dvec2(s::ground_half), 0.0);
  add_sphere(sphere, {s::sphere_centre[0], s::sphere_centre[1], s::sphere_centre[2]},
             glm::dvec3(s::sphere_radius), 5);
  builder.add("ground", ground, builder.material({"ground", {0.8, 0.8, 0.8}, true, {}, {}}));
  builder.add("sphere", sphere, builder.material({"sphere", {0.7, 0.3, 0.2}, false, {}, {}}));
  builder.camera({1.0, 6.0, 8.0}, {-0.6, 1.0, 0.0}, 42.0, 0.1);
  const glm::dvec3 light(s::light[0], s::light[1], s::light[2]);
  builder.spot(light, light - glm::dvec3(0, light.y, 0), 80.0, 0.7, s::light_side);
  return builder.glb();
}

std::string square_plane_scene() {
  namespace s = square_plane;
  Builder builder("square_plane");
  Shape ground, blocker;
  add_ground(ground, glm::dvec2(s::ground_half), 0.0);
  add_ground(blocker, glm::dvec2(s::blocker_half), s::blocker_height);
  builder.add("ground", ground, builder.material({"ground", {0.8, 0.8, 0.8}, true, {}, {}}));
  builder.add("blocker", blocker, builder.material({"blocker", {0.2, 0.4, 0.7}, true, {}, {}}));
  builder.camera({3.6, 3.2, 4.4}, {0.0, 0.5, 0.0}, 42.0, 0.1);
  builder.spot({0, s::light_height, 0}, {0, 0, 0}, 72.0, 0.7, s::light_side);
  return builder.glb();
}

std::string sun_and_lamp_scene() {
  namespace s = sun_and_lamp;
  Builder builder("sun_and_lamp");
  Shape ground, blocker, post;
  add_ground(ground, glm::dvec2(s::ground_half), 0.0);
  add_ground(blocker, glm::dvec2(s::blocker_half), s::blocker_height);
  add_box(post, {-0.5, 1.0, 0.5}, {0.25, 1.0, 0.25});
  builder.add("ground", ground, builder.material({"ground", {0.8, 0.8, 0.8}, true, {}, {}}));
  builder.add("blocker", blocker, builder.material({"blocker", {0.2, 0.4, 0.7}, true, {}, {}}));
  builder.add("post", post, builder.material({"post", {0.7, 0.3, 0.2}, false, {}, {}}));
  builder.camera({2.2, 3.4, 5.0}, {0.5, 0.4, 0.6}, 42.0, 0.1);
  builder.sun({s::sun_direction[0], s::sun_direction[1], s::sun_direction[2]}, 0.5, s::sun_degrees);
  const glm::dvec3 lamp(s::lamp[0], s::lamp[1], s::lamp[2]);
  builder.lamp(lamp, lamp.y, 0.3, s::lamp_radius);
  return builder.glb();
}

std::string area_shapes_scene() {
  namespace s = area_shapes;
  using Area = AreaLight;
  Builder builder("area_shapes");
  Shape ground, blocker;
  add_ground(ground, glm::dvec2(s::ground_half), 0.0);
  add_ground(blocker, glm::dvec2(s::blocker_half), s::blocker_height);
  builder.add("ground", ground, builder.material({"ground", {0.8, 0.8, 0.8}, true, {}, {}}));
  builder.add("blocker", blocker, builder.material({"blocker", {0.2, 0.4, 0.7}, true, {}, {}}));
  builder.camera({3.6, 5.2, 5.4}, {0.0, 0.2, 0.0}, 48.0, 0.1);
  const uint32_t window = builder.texture("window", window_png(), true);
  std::vector<glm::dvec2> outline;
  for (const auto& p : s::polygon) outline.emplace_back(p[0], p[1]);
  const double disc = 2 * s::disc_radius, sphere = 2 * s::sphere_radius, pane = s::window_side;
  const std::pair<const char*, Area> areas[] = {
      {"rectangle", {Area::Shape::rectangle, s::rectangle_width, s::rectangle_height, {}, {}}},
      {"disc", {Area::Shape::disc, disc, disc, {}, {}}},
      {"sphere", {Area::Shape::sphere, sphere, sphere, {}, {}}},
      {"polygon", polygon_light(outline)},
      {"window", {Area::Shape::rectangle, pane, pane, {}, window}}};
  for (size_t i = 0; i < std::size(areas); ++i) {
    const glm::dvec3 place(s::lights[i][0], 0, s::lights[i][1]), up(0, s::light_height, 0);
    builder.area_spot(areas[i].first, place + up, place, 84.0, 0.15, areas[i].second);
  }
  return builder.glb();
}

}  // namespace gnomon::generate
