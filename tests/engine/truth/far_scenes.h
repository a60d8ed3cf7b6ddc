// A small scene, and what may stand far away from it.
#pragma once

#include <utility>

#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon::analytic {

// A plate of 2 cm, 1 cm above the ground, seen from 10 cm, with a light above it.
inline Scene plate_scene(LightType type = LightType::point) {
  Scene scene;
  add(scene, square(0.1f), {0, 0, 0});
  add(scene, square(0.01f), {0, 0.01, 0});
  scene.cameras.push_back(camera({0.05, 0.08, 0.06}, {0, 0, 0}));
  scene.cameras[0].near = 0.001;
  scene.lights.push_back(light(type, {0.03, 0.2, -0.02}));
  return scene;
}

// Inside out, so that a camera within sees it.
inline Mesh dome(float radius) {
  Mesh mesh = sphere(radius, 12, 24);
  for (size_t t = 0; t < mesh.triangles(); ++t) std::swap(mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]);
  for (glm::vec3& n : mesh.normals) n = -n;
  return mesh;
}

inline Mesh triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  Mesh mesh;
  mesh.positions = {a, b, c};
  mesh.normals.assign(3, glm::normalize(glm::cross(b - a, c - a)));
  mesh.uvs.assign(3, glm::vec2(0));
  mesh.indices = {0, 1, 2};
  finish(mesh);
  return mesh;
}

}  // namespace gnomon::analytic
