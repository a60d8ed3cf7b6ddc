// Edges and triangles of a scene's casters, as shadow volumes need them on the device.
#include "passes/volume/silhouette_mesh.h"
#include "engine/render/gpu_scene.h"
#include "engine/scene/scene.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace gnomon {
namespace {

// For each vertex the first one (in sorted order) of exactly equal position.
std::vector<uint32_t> weld(const std::vector<glm::vec3>& positions) {
  const auto key = [&](uint32_t i) {
    return std::make_tuple(positions[i].x, positions[i].y, positions[i].z);
  };
  std::vector<uint32_t> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  for (size_t i = 0; i < order.size(); ++i)
    first[order[i]] =
        i > 0 && positions[order[i]] == positions[order[i - 1]] ? first[order[i - 1]] : order[i];
  return first;
}

struct HalfEdge {
  uint32_t low, high, incident;
  bool operator<(const HalfEdge& o) const {
    return std::tie(low, high, incident) < std::tie(o.low, o.high, o.incident);
  }
};

// Edges of one mesh; triangles and vertices counted from 0.
struct MeshEdges {
  std::vector<CasterEdge> edges;
  std::vector<uint32_t> incidents;
};

MeshEdges mesh_edges(const Mesh& mesh) {
  const std::vector<uint32_t> welded = weld(mesh.positions);
  std::vector<HalfEdge> halves;
  halves.reserve(mesh.indices.size());
  for (uint32_t t = 0; t < mesh.triangles(); ++t)
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t a = welded[mesh.indices[3 * t + k]], b = welded[mesh.indices[3 * t + (k + 1) % 3]];
      if (a != b) halves.push_back({std::min(a, b), std::max(a, b), 2 * t + (a < b ? 0u : 1u)});
    }
  std::sort(halves.begin(), halves.end());
  MeshEdges result;
  for (const HalfEdge& h : halves) {
    if (result.edges.empty() || result.edges.back().a != h.low || result.edges.back().b != h.high)
      result.edges.push_back({h.low, h.high, uint32_t(result.incidents.size()), 0});
    ++result.edges.back().count;
    result.incidents.push_back(h.incident);
  }
  return result;
}

}  // namespace

uint32_t silhouette_groups(uint64_t items) {
  constexpr uint64_t kGroup = 64, kMost = 65535;
  return uint32_t(std::min((items + kGroup - 1) / kGroup, kMost));
}

bool may_be_seen_through(const Draw& draw, bool solid) {
  const bool closed = solid && !draw.double_sided;
  return !closed && (!draw.double_sided || draw.alpha_masked);
}

SilhouetteMesh silhouette_mesh(const GpuScene& gpu_scene, const std::vector<bool>& solid) {
  const Scene& scene = gpu_scene.scene();
  std::vector<MeshEdges> of_mesh;
  for (const Mesh& mesh : scene.meshes) of_mesh.push_back(mesh_edges(mesh));
  SilhouetteMesh result;
  for (const Draw& draw : gpu_scene.draws()) {
    const uint32_t mesh_index = scene.instances[draw.instance].mesh;
    const Mesh& mesh = scene.meshes[mesh_index];
    const uint32_t vertex = gpu_scene.first_vertex(mesh_index);
    const uint32_t first_incident = uint32_t(result.incidents.size());
    const uint32_t first_triangle = uint32_t(result.triangles.size());
    const bool see_through = may_be_seen_through(draw, solid[mesh_index]);
    const uint32_t tag = draw.instance | (see_through ? CasterTriangle::see_through : 0);
    for (size_t i = 0; i < mesh.indices.size(); i += 3)
      result.triangles.push_back(
          {vertex + mesh.indices[i], vertex + mesh.indices[i + 1], vertex + mesh.indices[i + 2], tag});
    for (const CasterEdge& e : of_mesh[mesh_index].edges)
      result.edges.push_back({vertex + e.a, vertex + e.b, first_incident + e.first, e.count});
    for (const uint32_t i : of_mesh[mesh_index].incidents) result.incidents.push_back(i + 2 * first_triangle);
  }
  return result;
}

}  // namespace gnomon
