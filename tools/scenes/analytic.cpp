#include "tools/scene_generate.h"
#include "tools/scenes/scenes.h"
#include "tools/scenes/shapes.h"

namespace gnomon::generate {

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

}  // namespace gnomon::generate
