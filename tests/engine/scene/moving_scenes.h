// Scenes built in code, some of whose parts move.
#pragma once

#include <memory>

#include "engine/scene/animation.h"
#include "engine/scene/scene.h"

namespace gnomon::analytic {

// From one place to another within a second.
inline Track line(const glm::dvec3& from, const glm::dvec3& to) {
  return {Interpolation::linear, {0, 1}, {glm::dvec4(from, 0), glm::dvec4(to, 0)}};
}
// Stands still, and from a time on elsewhere.
inline Track jump(const glm::dvec3& by, double seconds) {
  return {Interpolation::step, {0, seconds}, {glm::dvec4(0), glm::dvec4(by, 0)}};
}

// Moves instances, cameras and lights of a scene from where they are, each along a translation of its own.
struct Mover {
  Scene scene;
  std::shared_ptr<Animation> animation = std::make_shared<Animation>();

  explicit Mover(Scene still) : scene(std::move(still)) { scene.animation = animation; }
  Mover& instance(uint32_t i, const Track& track) {
    animation->instances.push_back({i, animation->nodes.size(), scene.instances[i].world_from_object});
    scene.instances[i].moving = true;
    return along(track);
  }
  Mover& camera(const Track& track) {
    animation->cameras.push_back({0, animation->nodes.size(), scene.cameras[0].world_from_camera});
    scene.cameras[0].moving = true;
    return along(track);
  }
  Mover& light(const Track& track) {
    animation->lights.push_back({0, animation->nodes.size(), scene.lights[0].world_from_light});
    scene.lights[0].moving = true;
    return along(track);
  }
  // A line by so much within a second.
  Mover& instance(uint32_t i, const glm::dvec3& by) { return instance(i, line({0, 0, 0}, by)); }
  Mover& camera(const glm::dvec3& by) { return camera(line({0, 0, 0}, by)); }
  Mover& light(const glm::dvec3& by) { return light(line({0, 0, 0}, by)); }

 private:
  Mover& along(const Track& track) {
    animation->nodes.push_back({{}, {}, track, {}, {}, true});
    return *this;
  }
};

}  // namespace gnomon::analytic
