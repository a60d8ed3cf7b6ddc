// Scenes built in code, whose shadows have closed forms.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>

#include "engine/scene/scene.h"

namespace gnomon::analytic {

// Rigid frame at `eye` that looks along -z towards `target`.
inline glm::dmat4 frame(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
  return glm::inverse(glm::lookAt(eye, target, up));
}

inline void finish(Mesh& mesh) {
  for (const glm::vec3& p : mesh.positions) mesh.bounds.add(p);
}

// Square in the plane y = 0, front side up (or down), uv (0, 0) at (-half, -half), (1, 1) at (half, half) of
// x, z.
inline Mesh square(float half, bool up = true) {
  Mesh mesh;
  mesh.positions = {{-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half}};
  mesh.uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  mesh.normals.assign(4, {0, up ? 1 : -1, 0});
  if (up)
    mesh.indices = {0, 1, 2, 0, 2, 3};
  else
    mesh.indices = {0, 2, 1, 0, 3, 2};
  finish(mesh);
  return mesh;
}

inline Mesh sphere(float radius, int rings, int segments) {
  Mesh mesh;
  for (int i = 0; i <= rings; ++i)
    for (int k = 0; k < segments; ++k) {
      const double a = std::numbers::pi * i / rings, b = 2 * std::numbers::pi * k / segments;
      const glm::vec3 n(std::sin(a) * std::cos(b), std::cos(a), -std::sin(a) * std::sin(b));
      mesh.normals.push_back(n);
      mesh.positions.push_back(radius * n);
      mesh.uvs.emplace_back(0);
    }
  const auto vertex = [&](int i, int k) { return static_cast<uint32_t>(i * segments + k % segments); };
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < segments; ++k) {
      const uint32_t a = vertex(i, k), b = vertex(i + 1, k), c = vertex(i + 1, k + 1), d = vertex(i, k + 1);
      if (i < rings - 1) mesh.indices.insert(mesh.indices.end(), {a, b, c});
      if (i > 0) mesh.indices.insert(mesh.indices.end(), {a, c, d});
    }
  mesh.watertight = true;
  finish(mesh);
  return mesh;
}

// A cube of half side `half` about the origin; its faces look outwards or inwards.
inline Mesh cube(float half, bool outwards = true) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      const auto first = static_cast<uint32_t>(mesh.positions.size());
      for (int i = 0; i < 4; ++i) {
        glm::vec3 p(0), n(0);
        p[axis] = side;
        p[(axis + 1) % 3] = i == 1 || i == 2 ? side : -side;
        p[(axis + 2) % 3] = i >= 2 ? 1.0f : -1.0f;
        n[axis] = outwards ? side : -side;
        mesh.positions.push_back(half * p);
        mesh.normals.push_back(n);
        mesh.uvs.emplace_back(0);
      }
      for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
    }
  if (!outwards)
    for (size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  mesh.watertight = true;
  finish(mesh);
  return mesh;
}

inline void add(Scene& scene, Mesh mesh, const glm::dvec3& at, Material material = {}) {
  mesh.material = static_cast<uint32_t>(scene.materials.size());
  scene.materials.push_back(std::move(material));
  scene.meshes.push_back(std::move(mesh));
  Instance instance;
  instance.mesh = static_cast<uint32_t>(scene.meshes.size() - 1);
  instance.world_from_object = glm::translate(glm::dmat4(1.0), at);
  for (const glm::vec3& p : scene.meshes.back().positions) scene.bounds.add(glm::dvec3(p) + at);
  scene.instances.push_back(instance);
}

inline Camera camera(const glm::dvec3& eye, const glm::dvec3& target) {
  Camera camera;
  camera.world_from_camera = frame(eye, target, {0, 1, 0});
  return camera;
}

inline const char* name_of(LightType type) {
  const char* names[] = {"spot", "point", "directional"};
  return names[int(type)];
}

inline Light light(LightType type, const glm::dvec3& at, const glm::dvec3& target = {0, 0, 0}) {
  Light light;
  light.type = type;
  light.world_from_light = frame(at, target, {0, 0, 1});
  light.outer_cone = 1.5;  // no cone inside the square frustum of 90 degrees
  return light;
}

constexpr double blocker_height = 2, blocker_half = 1;

// A square of side 2 at height 2 above a plane at height 0.
inline Scene square_over_plane(const Light& light) {
  Scene scene;
  add(scene, square(20), {0, 0, 0});
  add(scene, square(blocker_half), {0, blocker_height, 0});
  scene.cameras.push_back(camera({6, 8, 7}, {0, 0, 0}));
  scene.lights.push_back(light);
  return scene;
}

// The whole scene moved.
inline Scene moved(Scene scene, const glm::dvec3& by) {
  const glm::dmat4 shift = glm::translate(glm::dmat4(1.0), by);
  for (Instance& instance : scene.instances) instance.world_from_object = shift * instance.world_from_object;
  for (Camera& camera : scene.cameras) camera.world_from_camera = shift * camera.world_from_camera;
  for (Light& light : scene.lights) light.world_from_light = shift * light.world_from_light;
  scene.bounds.min += by;
  scene.bounds.max += by;
  return scene;
}

}  // namespace gnomon::analytic
