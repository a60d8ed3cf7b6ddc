// The reference against plain loops over all triangles in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <limits>
#include <optional>
#include <random>

#include "engine/truth/reference.h"
#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

struct Triangle {
  glm::dvec3 a, b, c;
  bool double_sided = false;
};

std::vector<Triangle> all_triangles(const Scene& scene) {
  std::vector<Triangle> result;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const auto corner = [&](size_t i) {
      return glm::dvec3(instance.world_from_object * glm::dvec4(mesh.positions[mesh.indices[i]], 1.0));
    };
    for (size_t t = 0; t < mesh.triangles(); ++t)
      result.push_back(
          {corner(3 * t), corner(3 * t + 1), corner(3 * t + 2), scene.materials[mesh.material].double_sided});
  }
  return result;
}

// Moller and Trumbore 1997.
std::optional<double> intersect(const Triangle& t, const glm::dvec3& from, const glm::dvec3& direction) {
  const glm::dvec3 ab = t.b - t.a, ac = t.c - t.a, p = glm::cross(direction, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant == 0) return std::nullopt;
  const glm::dvec3 s = (from - t.a) / determinant, q = glm::cross(s, ab);
  const double u = glm::dot(s, p), v = glm::dot(direction, q);
  if (u < 0 || v < 0 || u + v > 1) return std::nullopt;
  return glm::dot(ac, q);
}

struct Counts {
  int hits = 0, shadowed = 0, wrong_depth = 0, wrong_visibility = 0;
};

Counts compare(const Scene& scene, uint32_t width, uint32_t height) {
  ReferenceSettings settings;
  settings.width = width, settings.height = height;
  const Reference r = ReferenceTracer(scene).trace(settings);
  const auto triangles = all_triangles(scene);
  const glm::dmat4& view = scene.cameras[0].world_from_camera;
  const double tangent = std::tan(scene.cameras[0].fov_y / 2);
  const glm::dvec3 eye(view[3]), light(scene.lights[0].world_from_light[3]);
  Counts counts;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      const glm::dvec3 direction =
          glm::dmat3(view) * glm::dvec3(tangent * width / height * ((x + 0.5) / width * 2 - 1),
                                        tangent * (1 - (y + 0.5) / height * 2), -1);
      double depth = std::numeric_limits<double>::infinity();
      size_t nearest = 0;
      for (size_t i = 0; i < triangles.size(); ++i) {
        const Triangle& t = triangles[i];
        if (!t.double_sided && glm::dot(glm::cross(t.b - t.a, t.c - t.a), direction) >= 0) continue;
        const auto hit = intersect(t, eye, direction);
        if (hit && *hit > scene.cameras[0].near && *hit < depth) depth = *hit, nearest = i;
      }
      const size_t pixel = size_t{y} * width + x;
      if (std::isinf(depth)) {
        counts.wrong_depth += !std::isinf(r.depth[pixel]);
        continue;
      }
      ++counts.hits;
      if (!(std::abs(r.depth[pixel] - depth) < 1e-5 * depth)) {
        ++counts.wrong_depth;
        continue;
      }
      const Triangle& on = triangles[nearest];
      glm::dvec3 normal = glm::cross(on.b - on.a, on.c - on.a);
      if (glm::dot(normal, direction) > 0) normal = -normal;
      const glm::dvec3 point = eye + depth * direction;
      bool lit = glm::dot(normal, light - point) > 0;
      // Triangles that share the point's edge or plane meet the ray at its start.
      for (size_t i = 0; lit && i < triangles.size(); ++i) {
        if (i == nearest) continue;
        const auto hit = intersect(triangles[i], point, light - point);
        lit = !(hit && *hit > 1e-6 && *hit < 1);
      }
      counts.shadowed += !lit;
      counts.wrong_visibility += lit != (r.visibility[0][pixel] == 1);
    }
  return counts;
}

void expect_agreement(const Counts& c) {
  EXPECT_GT(c.hits, 500);
  EXPECT_GT(c.shadowed, 50);
  // Rays within a float's rounding of an edge may fall on either side of it.
  EXPECT_LE(c.wrong_depth, c.hits / 1000 + 1);
  EXPECT_LE(c.wrong_visibility, c.hits / 1000 + 1);
}

TEST(ReferenceBruteForce, RandomTriangles) {
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() * 0x1p-32); };
  for (const bool double_sided : {true, false}) {
    Mesh mesh;
    for (uint32_t i = 0; i < 900; ++i) {
      if (i % 3 == 0) mesh.positions.emplace_back(uniform(-3, 3), uniform(-2, 2), uniform(-3, 3));
      if (i % 3 != 0)
        mesh.positions.push_back(mesh.positions[i - i % 3] +
                                 glm::vec3(uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(-0.5, 0.5)));
      mesh.indices.push_back(i);
    }
    Scene scene;
    Material material;
    material.double_sided = double_sided;
    analytic::add(scene, mesh, {1, 2, 3}, material);
    scene.cameras.push_back(analytic::camera({4, 6, 9}, {1, 2, 3}));
    scene.lights.push_back(analytic::light(LightType::point, {-3, 7, 8}));
    expect_agreement(compare(scene, 96, 72));
  }
}

// A model of real irregularity, where there is one.
TEST(ReferenceBruteForce, Raptor) {
  const char* given = std::getenv("GNOMON_SCENES");
  const auto root = std::filesystem::path(__FILE__).parent_path().parent_path().parent_path();
  const auto file =
      (given ? std::filesystem::path(given) : root.parent_path() / "shared" / "scenes") / "raptor.glb";
  if (!std::filesystem::exists(file)) {
    std::cout << file << ": not there; random triangles alone are compared\n";
    return;
  }
  const Scene scene = load_scene(file);
  expect_agreement(compare(scene, 96, 54));
}

}  // namespace
}  // namespace gnomon
