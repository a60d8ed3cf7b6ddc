// Edges and triangles of a scene's casters, as shadow volumes need them on the device.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/render/gpu_scene.h"

namespace gnomon {

// Mirrors shaders/glsl/volume/shadow_volumes.glsl. Vertices are indices into the scene's positions.
struct CasterTriangle {
  static constexpr uint32_t closed = 1u << 31;       // cast from the triangles that face away from the light
  static constexpr uint32_t see_through = 1u << 30;  // the camera may look through its surface
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
  uint64_t most_quads = 0;          // sides of a volume, at most: for any light
};

// May this instance cast from its far side alone? Watertight, and never seen from within.
bool casts_from_far_side(const Draw& draw);
SilhouetteMesh silhouette_mesh(const GpuScene& scene);

}  // namespace gnomon
