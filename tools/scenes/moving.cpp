// The scenes that move: pendulum and moving_light.
#include <cmath>
#include <numbers>

#include "tools/scenes/scenes.h"
#include "tools/scenes/shapes.h"

namespace gnomon::generate {
namespace {

constexpr double kPeriod = 2.0;  // seconds
constexpr int kKeys = 24;        // of a period; the last one is the first again

// One key frame at each of `keys` + 1 places, from phase 0 to 1.
template <class Place>
Motion motion(const char* property, Place place) {
  Motion result;
  result.property = property;
  for (int i = 0; i <= kKeys; ++i) {
    const double phase = static_cast<double>(i) / kKeys;
    result.times.push_back(phase * kPeriod);
    result.values.push_back(place(phase));
  }
  return result;
}

double wave(double phase) { return std::cos(2.0 * std::numbers::pi * phase); }
double quarter_later(double phase) { return std::sin(2.0 * std::numbers::pi * phase); }

struct Colors {
  glm::dvec3 ground{0.8}, bob{0.7, 0.3, 0.2}, post{0.2, 0.4, 0.7};
};

void add_ground_and_post(Builder& builder) {
  Shape ground, post;
  add_ground(ground, glm::dvec2(4.0), 0.0);
  add_box(post, {1.2, 0.6, -0.8}, {0.15, 0.6, 0.15});
  builder.add("ground", ground, builder.material({"ground", Colors().ground, true, {}, {}}));
  builder.add("post", post, builder.material({"post", Colors().post, false, {}, {}}));
}

}  // namespace

std::string pendulum() {
  Builder builder("pendulum");
  add_ground_and_post(builder);
  Shape bob;  // the origin is the pivot
  add_box(bob, {0, -0.75, 0}, {0.04, 0.75, 0.04});
  add_box(bob, {0, -1.8, 0}, {0.3, 0.3, 0.3});
  const uint32_t mesh = builder.mesh("bob", bob, builder.material({"bob", Colors().bob, false, {}, {}}));
  Placement hanging;
  hanging.translation = {0, 2.6, 0};
  builder.node("bob", mesh, hanging);
  builder.move("bob", motion("rotation", [](double phase) {
                 return rotation_value(turn(40.0 * wave(phase), {0, 0, 1}));
               }));
  const glm::dvec3 target(0.2, 0.6, 0.0);
  builder.camera({3.6, 3.2, 4.4}, target, 42.0, 0.1);
  builder.camera({3.6, 3.2, 4.4}, target, 42.0, 0.1);  // the second one swings about the scene
  const auto eye = [&](double phase) {
    return turn(15.0 * quarter_later(phase), {0, 1, 0}) * glm::dvec3(3.6, 3.2, 4.4);
  };
  builder.move("camera", motion("translation", [&](double phase) { return glm::dvec4(eye(phase), 0.0); }));
  builder.move("camera", motion("rotation",
                                [&](double phase) { return rotation_value(looking(target - eye(phase))); }));
  builder.spot({-1.5, 6.0, 1.5}, {0, 0, 0}, 60.0, 0.7, 0.4);
  return builder.glb();
}

std::string moving_light() {
  Builder builder("moving_light");
  add_ground_and_post(builder);
  Shape sphere;
  add_sphere(sphere, {-0.6, 0.9, 0.2}, glm::dvec3(0.5), 3);
  builder.add("sphere", sphere, builder.material({"sphere", Colors().bob, false, {}, {}}));
  builder.camera({3.6, 3.2, 4.4}, {0.2, 0.6, 0.0}, 42.0, 0.1);
  const auto place = [](double phase) {
    return glm::dvec3(2.0 * wave(phase), 6.0, 2.0 * quarter_later(phase));
  };
  builder.spot(place(0), {0, 0, 0}, 60.0, 0.7, 0.4);
  builder.move("light", motion("translation", [&](double phase) { return glm::dvec4(place(phase), 0.0); }));
  builder.move("light",
               motion("rotation", [&](double phase) { return rotation_value(looking(-place(phase))); }));
  return builder.glb();
}

}  // namespace gnomon::generate
