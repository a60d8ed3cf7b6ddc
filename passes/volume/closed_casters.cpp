// Decides which casters may cast from their far side alone.
#include "passes/volume/closed_casters.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>

#include "engine/scene/mesh_clean.h"
#include "passes/volume/near_plane_shadow.h"

namespace gnomon {
namespace {

constexpr size_t kMostHollows = 16;  // more are not looked into: each takes a turn over the whole mesh

using Corners = std::array<glm::dvec3, 3>;

Corners corners_of(const Mesh& mesh, size_t triangle) {
  const auto at = [&](size_t k) { return glm::dvec3(mesh.positions[mesh.indices[3 * triangle + k]]); };
  return {at(0), at(1), at(2)};
}

// For each vertex one that all vertices of its shell share: vertices of equal position are one.
std::vector<uint32_t> shells(const Mesh& mesh) {
  std::vector<uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const auto join = [&](uint32_t a, uint32_t b) { parent[root(a)] = root(b); };
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    join(mesh.indices[i], mesh.indices[i + 1]);
    join(mesh.indices[i], mesh.indices[i + 2]);
  }
  std::vector<uint32_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](uint32_t v) {
    const glm::vec3& p = mesh.positions[v];
    return std::make_tuple(p.x, p.y, p.z);
  };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  for (size_t i = 1; i < order.size(); ++i)
    if (mesh.positions[order[i]] == mesh.positions[order[i - 1]]) join(order[i], order[i - 1]);
  for (uint32_t v = 0; v < parent.size(); ++v) parent[v] = root(v);
  return parent;
}

// The mesh without a shell.
Mesh without(const Mesh& mesh, const std::vector<uint32_t>& shell, uint32_t name) {
  Mesh rest;
  rest.positions = mesh.positions;
  rest.bounds = mesh.bounds;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    if (shell[mesh.indices[i]] != name)
      rest.indices.insert(rest.indices.end(), &mesh.indices[i], &mesh.indices[i] + 3);
  return rest;
}

bool meets(const Bounds& a, const Bounds& b) {
  return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

// Is the near pyramid (points of the mesh's own space) in the mesh, or does it touch its surface?
bool in_or_at(const Mesh& mesh, const std::vector<glm::dvec3>& pyramid) {
  Bounds around;
  for (const glm::dvec3& p : pyramid) around.add(p);
  if (!meets(around, mesh.bounds)) return false;
  for (size_t t = 0; t < mesh.triangles(); ++t) {
    Bounds box;
    for (const glm::dvec3& p : corners_of(mesh, t)) box.add(p);
    if (meets(around, box)) return true;
  }
  return is_inside(mesh, pyramid.front());
}

}  // namespace

bool is_solid(const Mesh& mesh) {
  if (!mesh.watertight) return false;
  const std::vector<uint32_t> shell = shells(mesh);
  const glm::dvec3 centre = mesh.bounds.centre();  // so that far coordinates lose no digits
  std::map<uint32_t, double> volumes;              // six times each shell's
  for (size_t t = 0; t < mesh.triangles(); ++t) {
    const Corners c = corners_of(mesh, t);
    volumes[shell[mesh.indices[3 * t]]] += glm::dot(c[0] - centre, glm::cross(c[1] - centre, c[2] - centre));
  }
  size_t hollows = 0;
  for (const auto& [name, volume] : volumes) {
    if (volume > 0) continue;
    if (++hollows > kMostHollows) return false;
    if (!is_inside(without(mesh, shell, name), glm::dvec3(mesh.positions[name]))) return false;
  }
  return true;
}

std::vector<bool> solid_meshes(const Scene& scene) {
  std::vector<bool> solid;
  for (const Mesh& mesh : scene.meshes)
    solid.push_back(!scene.materials[mesh.material].double_sided && is_solid(mesh));
  return solid;
}

std::vector<bool> unseen_inside(const Scene& scene, const std::vector<bool>& solid, const Camera& camera,
                                double aspect) {
  const std::vector<glm::dvec3> pyramid = near_pyramid(camera, aspect);
  std::vector<bool> unseen;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    std::vector<glm::dvec3> local;
    const glm::dmat4 object_from_world = glm::inverse(instance.world_from_object);
    for (const glm::dvec3& p : pyramid) local.emplace_back(object_from_world * glm::dvec4(p, 1.0));
    unseen.push_back(solid[instance.mesh] && !in_or_at(mesh, local));
  }
  return unseen;
}

}  // namespace gnomon
