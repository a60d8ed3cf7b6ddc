// Edges and triangles of a scene's casters, as shadow volumes need them on the device.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/render/gpu_scene.h"

namespace gnomon {

// Mirrors shaders/glsl/volume/silhouettes.glsl. Vertices are indices into the scene's positions.
struct CasterTriangle {
  static constexpr uint32_t see_through = 1u << 31;  // the camera may look through its surface
  uint32_t a, b, c;
  uint32_t instance;  // and flags
};
struct CasterEdge {
  uint32_t a, b;
  uint32_t first, count;  // of the edge's triangles in SilhouetteMesh::incidents
};

struct SilhouetteMesh {
  std::vector<CasterTriangle> triangles;
  std::vector<CasterEdge> edges;
  std::vector<uint32_t> incidents;  // triangle * 2, and 1 where it runs along its edge from b to a
};

// May the camera look through an instance's surface? `solid`: is_solid() of its mesh (closed_casters.h).
bool may_be_seen_through(const Draw& draw, bool solid);
SilhouetteMesh silhouette_mesh(const GpuScene& scene, const std::vector<bool>& solid);

// Workgroups, of 64, for so many triangles or edges: no more than every device dispatches, so that shaders
// step over the rest.
uint32_t silhouette_groups(uint64_t items);

}  // namespace gnomon
