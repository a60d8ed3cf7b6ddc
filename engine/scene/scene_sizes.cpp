// Counts a scene's geometry.
#include "engine/scene/scene_sizes.h"

#include <algorithm>

#include "engine/scene/scene.h"

namespace gnomon {

SceneSizes scene_sizes(const Scene& scene) {
  SceneSizes sizes{scene.instances.size(), 0, 0, 0, 0};
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const uint64_t triangles = mesh.triangles();
    sizes.vertices += mesh.positions.size();
    sizes.triangles += triangles;
    sizes.edges += 3 * triangles;
    sizes.sides += 3 * triangles;
  }
  for (uint64_t* count : {&sizes.vertices, &sizes.triangles, &sizes.edges, &sizes.sides})
    *count = std::max<uint64_t>(*count, 1);  // buffers have no size 0
  return sizes;
}

}  // namespace gnomon
