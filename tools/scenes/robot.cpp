// The scene robot: a figure of closed parts.
#include "tools/scenes/scenes.h"
#include "tools/scenes/shapes.h"

namespace gnomon::generate {
namespace {

struct Part {
  const char* name;
  int surface;  // 0 shell, 1 joint, 2 accent
  glm::dvec3 at, half;
  double angle;  // degrees
  glm::dvec3 axis;
};

const Part parts[] = {
    {"torso", 0, {0, 3.3, 0}, {0.75, 0.95, 0.45}, 8, {0.2, 1, 0.1}},
    {"pelvis", 1, {0, 2.1, 0}, {0.55, 0.22, 0.38}, -6, {0, 1, 0}},
    {"neck", 1, {0.02, 4.38, 0}, {0.16, 0.16, 0.16}, 20, {0, 1, 0}},
    {"head", 0, {0.05, 4.95, 0.05}, {0.45, 0.42, 0.42}, 24, {0.25, 1, 0.15}},
    {"visor", 2, {0.24, 5.0, 0.45}, {0.3, 0.1, 0.08}, 24, {0.25, 1, 0.15}},
    {"antenna", 1, {0.1, 5.85, 0}, {0.03, 0.5, 0.03}, 12, {0, 0, 1}},
    {"left upper arm", 0, {1.2, 3.85, 0.1}, {0.6, 0.2, 0.22}, 38, {0, 0.3, 1}},
    {"left lower arm", 1, {1.95, 4.75, 0.35}, {0.18, 0.62, 0.18}, -22, {0.4, 0, 1}},
    {"left hand", 2, {2.2, 5.5, 0.55}, {0.26, 0.2, 0.16}, 33, {1, 0.5, 0.2}},
    {"right upper arm", 0, {-1.15, 3.55, 0.05}, {0.55, 0.2, 0.22}, 35, {0, -0.2, 1}},
    {"right lower arm", 1, {-1.62, 2.75, 0.5}, {0.18, 0.6, 0.18}, -48, {1, 0.2, 0.1}},
    {"right hand", 2, {-1.6, 2.4, 1.1}, {0.24, 0.2, 0.2}, 52, {0.3, 1, 0.4}},
    {"left thigh", 0, {0.42, 1.45, 0.15}, {0.24, 0.52, 0.26}, -14, {1, 0, 0.3}},
    {"left shin", 1, {0.5, 0.66, 0.12}, {0.2, 0.5, 0.22}, 12, {1, 0, 0}},
    {"left foot", 2, {0.52, 0.13, 0.28}, {0.28, 0.12, 0.48}, 9, {0, 1, 0}},
    {"right thigh", 0, {-0.5, 1.5, -0.12}, {0.24, 0.52, 0.26}, 17, {1, 0, -0.4}},
    {"right shin", 1, {-0.62, 0.68, -0.32}, {0.2, 0.5, 0.22}, 10, {1, 0, 0.2}},
    {"right foot", 2, {-0.66, 0.13, -0.2}, {0.28, 0.12, 0.48}, -21, {0, 1, 0}},
};

}  // namespace

std::string robot() {
  Builder builder("robot");
  Shape ground, cube;
  add_ground(ground, {9.0, 8.5}, 0.0, 8);
  add_box(cube, glm::dvec3(0.0), glm::dvec3(1.0));
  builder.add("floor", ground, builder.material({"floor", {0.7, 0.7, 0.72}, true, {}, {}}));
  const uint32_t cubes[] = {
      builder.mesh("shell", cube, builder.material({"shell", {0.75, 0.75, 0.7}, false, {}, {}})),
      builder.mesh("joint", cube, builder.material({"joint", {0.25, 0.27, 0.3}, false, {}, {}})),
      builder.mesh("accent", cube, builder.material({"accent", {0.8, 0.3, 0.1}, false, {}, {}})),
      builder.mesh("crate", cube, builder.material({"crate", {0.5, 0.38, 0.24}, false, {}, {}}))};
  for (const Part& part : parts)
    builder.node(part.name, cubes[part.surface],
                 {part.at, turn(part.angle, glm::normalize(part.axis)), part.half});
  Random random(5);
  for (int i = 0; i < 26; ++i) {
    const double x = random.in(-6.5, 6.5), z = random.in(-4.5, 4.0);
    if (x * x + z * z < 5.0) continue;
    const glm::dvec3 half = in_box(random, glm::dvec3(0.15), glm::dvec3(0.5));
    const glm::dvec3 axis = glm::normalize(in_box(random, {-1, 0.2, -1}, {1, 1, 1}));
    builder.node("crate", cubes[3], {{x, random.in(0.3, 0.7), z}, turn(random.in(0, 90), axis), half});
  }
  builder.camera({3.2, 5.6, 11.5}, {0.2, 1.9, 0.2}, 45.0, 0.1);
  builder.spot({-10.0, 16.0, -11.0}, {0.6, 1.2, 1.0}, 46.0);
  return builder.glb();
}

}  // namespace gnomon::generate
