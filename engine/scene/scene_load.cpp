// Loads a glTF file as a scene.
// Reads a glTF file as a scene.
#include <algorithm>

#include "engine/base/error.h"
#include "engine/scene/gltf_animation.h"
#include "engine/scene/gltf_file.h"
#include "engine/scene/scene.h"
#include "engine/scene/scene_instances.h"
#include "engine/scene/scene_nodes.h"
#include "engine/scene/scene_primitive.h"

namespace gnomon {
namespace {

// Meshes that only mirrored or flattened instances used are left without one: drop them.
void drop_unused_meshes(Scene& scene) {
  std::vector<uint32_t> place(scene.meshes.size(), UINT32_MAX);
  for (const Instance& instance : scene.instances) place[instance.mesh] = 0;
  std::vector<Mesh> kept;
  for (size_t i = 0; i < place.size(); ++i) {
    if (place[i] == UINT32_MAX) continue;
    place[i] = static_cast<uint32_t>(kept.size());
    kept.push_back(std::move(scene.meshes[i]));
  }
  for (Instance& instance : scene.instances) instance.mesh = place[instance.mesh];
  scene.meshes = std::move(kept);
}

// Says what has been left out and why.
[[noreturn]] void fail_without_triangles(const GltfFile& gltf, const std::vector<PlacedNode>& nodes,
                                         const SceneWarnings& warnings) {
  constexpr size_t most = 8;  // told
  std::string hint;
  size_t told = 0;
  for (const std::string& message : warnings.messages) {
    const std::string start = gltf.file + ": /meshes/";
    if (message.rfind(start, 0) != 0 || ++told > most) continue;
    hint += (hint.empty() ? "" : "; ") + message.substr(gltf.file.size() + 2);
  }
  if (told > most) hint += "; and " + std::to_string(told - most) + " more";
  const bool hidden = std::any_of(nodes.begin(), nodes.end(), [&](const PlacedNode& placed) {
    return !placed.visible && gltf.model.nodes[placed.node].mesh >= 0;
  });
  if (hidden) hint += std::string(hint.empty() ? "" : "; ") + "nodes are hidden by KHR_node_visibility";
  fail("no triangles: no node of the scene places a mesh with triangles that have an area", gltf.file,
       "/scenes", hint);
}

Bounds world_bounds(const Scene& scene) {
  Bounds bounds;
  for (const Instance& instance : scene.instances)
    for (const glm::vec3& p : scene.meshes[instance.mesh].positions)
      bounds.add(glm::dvec3(instance.world_from_object * glm::dvec4(glm::dvec3(p), 1.0)));
  return bounds;
}

}  // namespace

uint64_t Scene::triangles() const {
  uint64_t count = 0;
  for (const Instance& instance : instances) count += meshes[instance.mesh].triangles();
  return count;
}

Scene load_scene(const std::filesystem::path& file) {
  Scene scene;
  scene.file = file;
  scene.name = file.stem().string();
  const GltfFile gltf = read_gltf(file, scene.warnings);
  std::vector<PlacedNode> nodes = walk_nodes(gltf, scene.warnings);
  const std::shared_ptr<Animation> animation = read_animation(gltf, nodes, scene.warnings);
  read_materials(gltf, scene);
  read_instances(gltf, nodes, scene, animation.get());
  drop_unused_meshes(scene);
  if (scene.instances.empty()) fail_without_triangles(gltf, nodes, scene.warnings);
  scene.bounds = world_bounds(scene);
  read_cameras(gltf, nodes, scene, animation.get());
  read_lights(gltf, nodes, scene, animation.get());
  if (animation && !(animation->instances.empty() && animation->cameras.empty() && animation->lights.empty()))
    scene.animation = animation;
  ensure_camera(scene);
  ensure_light(scene);
  warn_enclosed_lights(scene);
  return scene;
}

}  // namespace gnomon
