// Loads a glTF file as a scene.
#include <algorithm>

#include "engine/base/error.h"
#include "engine/scene/gltf_animation.h"
#include "engine/scene/gltf_file.h"
#include "engine/scene/scene.h"
#include "engine/scene/scene_instances.h"
#include "engine/scene/scene_limits.h"
#include "engine/scene/scene_nodes.h"
#include "engine/scene/scene_primitive.h"

namespace gnomon {
namespace {

// Meshes that only mirrored or flattened instances used are left without one: drop them.
// `animation`: may be null.
void drop_unused_meshes(Scene& scene, Animation* animation) {
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
  if (animation == nullptr) return;
  for (Deformation& deformation : animation->deformations) deformation.mesh = place[deformation.mesh];
  std::erase_if(animation->deformations, [](const Deformation& d) { return d.mesh == UINT32_MAX; });
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
    return !placed.ever_visible && gltf.model.nodes[placed.node].mesh >= 0;
  });
  if (hidden) hint += std::string(hint.empty() ? "" : "; ") + "nodes are hidden by KHR_node_visibility";
  fail("no triangles: no node of the scene places a mesh with triangles that have an area", gltf.file,
       "/scenes", hint);
}

// Materials that change: their values at rest, and where they are at time 0.
void start_materials(Scene& scene, Animation& animation) {
  for (ChangingMaterial& changing : animation.changing_materials) {
    Material& material = scene.materials[changing.material];
    changing.base_color = material.base_color;
    changing.alpha_cutoff = material.alpha_cutoff;
    if (changing.color)
      material.base_color = glm::clamp(glm::vec4(values_at(*changing.color, 0)), 0.0f, 1.0f);
    if (changing.cutoff) material.alpha_cutoff = static_cast<float>(values_at(*changing.cutoff, 0).x);
  }
}

Bounds world_bounds(const Scene& scene) {
  Bounds bounds;
  for (const Instance& instance : scene.instances)
    if (instance.visible)
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
  const GltfAnimation tracks = read_animation(gltf, nodes, scene.warnings);
  const std::shared_ptr<Animation>& animation = tracks.animation;
  read_materials(gltf, scene);
  if (animation) start_materials(scene, *animation);
  read_instances(gltf, nodes, scene, animation.get());
  drop_unused_meshes(scene, animation.get());
  if (scene.instances.empty()) fail_without_triangles(gltf, nodes, scene.warnings);
  scene.bounds = world_bounds(scene);
  read_cameras(gltf, nodes, scene, animation.get());
  read_lights(gltf, nodes, scene, animation.get(), tracks.intensities);
  if (animation && !is_idle(*animation)) scene.animation = animation;
  ensure_camera(scene);
  ensure_light(scene);
  check_limits(scene);
  warn_enclosed_lights(scene);
  return scene;
}

}  // namespace gnomon
