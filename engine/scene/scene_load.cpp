// Loads a glTF file as a scene.
#include <algorithm>
#include <cmath>
#include <map>

#include "engine/base/error.h"
#include "engine/scene/gltf_animation.h"
#include "engine/scene/gltf_file.h"
#include "engine/scene/mesh_clean.h"
#include "engine/scene/scene.h"
#include "engine/scene/scene_limits.h"
#include "engine/scene/scene_nodes.h"
#include "engine/scene/scene_primitive.h"

namespace gnomon {
namespace {

// How far a transform is from flattening space: |det| over the product of its axes' lengths, in [0, 1].
double regularity(const glm::dmat3& m) {
  const double lengths = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
  return lengths > 0 ? std::abs(glm::determinant(m)) / lengths : 0.0;
}

// Places the primitives of mesh nodes; reads each primitive once and shares it between its instances.
class InstanceReader {
 public:
  // `animation`: may be null.
  InstanceReader(const GltfFile& gltf, Scene& scene, Animation* animation)
      : gltf_(gltf), scene_(scene), animation_(animation) {}

  void read(const std::vector<PlacedNode>& nodes) {
    for (size_t n = 0; n < nodes.size(); ++n) {
      const PlacedNode& placed = nodes[n];
      const tinygltf::Node& node = gltf_.model.nodes[placed.node];
      if (node.mesh < 0) continue;
      if (static_cast<size_t>(node.mesh) >= gltf_.model.meshes.size())
        fail("no mesh " + std::to_string(node.mesh) + "; there are " +
                 std::to_string(gltf_.model.meshes.size()),
             gltf_.file, at(at("/nodes", placed.node), "mesh"));
      const auto mesh = static_cast<size_t>(node.mesh);
      for (size_t i = 0; i < gltf_.model.meshes[mesh].primitives.size(); ++i)
        place(mesh, i, placed, n, node.name);
    }
  }

 private:
  // `index`: of `placed`.
  void place(size_t mesh, size_t primitive, const PlacedNode& placed, size_t index, const std::string& name) {
    const std::optional<uint32_t> shape = read(mesh, primitive);
    if (!shape) return;
    Instance instance{name.empty() ? scene_.meshes[*shape].name : name, *shape, placed.world_from_node,
                      placed.moving};
    glm::dmat4 node_from_object(1.0);
    const glm::dmat3 axes(instance.world_from_object);
    if (regularity(axes) < 1e-9) {
      if (!flatten(instance, placed.node)) return;
    } else if (glm::determinant(axes) < 0) {
      instance.mesh = mirror(*shape);
      instance.world_from_object[0] = -instance.world_from_object[0];
      node_from_object[0] = -node_from_object[0];
    }
    if (instance.moving)
      animation_->instances.push_back(
          {static_cast<uint32_t>(scene_.instances.size()), index, node_from_object});
    scene_.instances.push_back(std::move(instance));
  }

  std::optional<uint32_t> read(size_t mesh, size_t primitive) {
    const auto [found, fresh] = loaded_.try_emplace({mesh, primitive});
    if (!fresh) return found->second;
    if (std::optional<Mesh> shape = read_primitive(gltf_, mesh, primitive, scene_.warnings))
      found->second = add(std::move(*shape));
    return found->second;
  }

  uint32_t add(Mesh mesh) {
    scene_.meshes.push_back(std::move(mesh));
    return static_cast<uint32_t>(scene_.meshes.size() - 1);
  }

  // A mirroring transform (glTF 2.0, 3.7.4) becomes a mirrored mesh, so that counter-clockwise is the front
  // everywhere.
  uint32_t mirror(uint32_t mesh) {
    const auto [found, fresh] = mirrored_.try_emplace(mesh, 0u);
    if (fresh) found->second = add(mirrored(scene_.meshes[mesh]));
    return found->second;
  }

  // A transform that flattens the mesh (a scale of 0) has no inverse: its linear part goes into a mesh of its
  // own.
  bool flatten(Instance& instance, size_t node) {
    const std::string place = at("/nodes", node);
    Mesh flat = scene_.meshes[instance.mesh];
    const glm::dmat3 axes(instance.world_from_object);
    for (glm::vec3& p : flat.positions) p = glm::vec3(axes * glm::dvec3(p));
    const DroppedTriangles dropped = drop_bad_triangles(flat);
    scene_.warnings.degenerate_triangles += dropped.degenerate;
    scene_.warnings.nonfinite_triangles += dropped.nonfinite;
    scene_.warnings.messages.push_back(gltf_.file + ": " + place + ": its scale flattens the mesh; dropped " +
                                       std::to_string(dropped.degenerate + dropped.nonfinite) +
                                       " triangles without area" +
                                       (instance.moving ? ", and it stands still" : ""));
    instance.moving = false;
    if (flat.indices.empty()) return false;
    make_flat_normals(flat);
    finish_mesh(flat);
    glm::dmat4 moved(1.0);
    moved[3] = instance.world_from_object[3];
    instance.world_from_object = moved;
    instance.mesh = add(std::move(flat));
    return true;
  }

  const GltfFile& gltf_;
  Scene& scene_;
  Animation* animation_;
  std::map<std::pair<size_t, size_t>, std::optional<uint32_t>> loaded_;
  std::map<uint32_t, uint32_t> mirrored_;
};

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
  InstanceReader(gltf, scene, animation.get()).read(nodes);
  drop_unused_meshes(scene);
  if (scene.instances.empty())
    fail("no triangles: no node of the scene places a mesh with triangles that have an area", gltf.file,
         "/scenes");
  scene.bounds = world_bounds(scene);
  read_cameras(gltf, nodes, scene, animation.get());
  read_lights(gltf, nodes, scene, animation.get());
  if (animation && !(animation->instances.empty() && animation->cameras.empty() && animation->lights.empty()))
    scene.animation = animation;
  ensure_camera(scene);
  ensure_light(scene);
  check_limits(scene);
  warn_enclosed_lights(scene);
  return scene;
}

}  // namespace gnomon
