// How much geometry a scene has: what the shapes of passes' buffers depend on.
#pragma once

#include <cstdint>

namespace gnomon {

struct Scene;  // engine/scene/scene.h

// All over instances: a mesh that is placed twice counts twice. Without a scene (listings, `check`): those of
// one triangle.
struct SceneSizes {
  uint64_t instances = 1;
  uint64_t vertices = 3;
  uint64_t triangles = 1;
  // At most so many edges, 3 a triangle: half as many of a watertight mesh, if it is as watertight as it
  // says. Vertices of equal position are one.
  uint64_t edges = 3;
  // Sides of all shadow volumes of one light, at most: an edge has one for each of its triangles, as those of
  // an open mesh do not cancel out.
  uint64_t sides = 3;
  bool operator==(const SceneSizes&) const = default;
};
SceneSizes scene_sizes(const Scene& scene);

}  // namespace gnomon
