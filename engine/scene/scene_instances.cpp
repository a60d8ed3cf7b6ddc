// Places meshes: one for each node that has one, or many of them (EXT_mesh_gpu_instancing).
#include "engine/scene/scene_instances.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "engine/base/error.h"
#include "engine/scene/gltf_accessor.h"
#include "engine/scene/gltf_deformation.h"
#include "engine/scene/mesh_clean.h"
#include "engine/scene/scene_primitive.h"

namespace gnomon {
namespace {

constexpr size_t kMaxInstances = size_t{1} << 20;

// The instance attributes of a node; each is optional, and all have one length.
class CopyReader {
 public:
  CopyReader(const GltfFile& gltf, size_t node, const tinygltf::Value& extension)
      : gltf_(gltf), place_(at(at("/nodes", node), "extensions/EXT_mesh_gpu_instancing/attributes")) {
    if (extension.IsObject() && extension.Has("attributes")) attributes_ = extension.Get("attributes");
  }

  std::vector<glm::dmat4> read() {
    const auto translations = values("TRANSLATION", 3), rotations = values("ROTATION", 4),
               scales = values("SCALE", 3);
    if (!count_)
      fail("no TRANSLATION, ROTATION or SCALE says how many instances there are", gltf_.file, place_);
    if (*count_ > kMaxInstances)
      fail("more than " + std::to_string(kMaxInstances) + " instances", gltf_.file, place_);
    std::vector<glm::dmat4> copies;
    for (size_t i = 0; i < *count_; ++i) {
      NodeTransform transform;
      if (!translations.empty()) transform.translation = glm::dvec3(translations[i]);
      if (!scales.empty()) transform.scale = glm::dvec3(scales[i]);
      if (!rotations.empty()) {
        const glm::dvec4 q(rotations[i]);
        if (glm::length(q) > 1e-12) transform.rotation = glm::normalize(glm::dquat(q.w, q.x, q.y, q.z));
      }
      copies.push_back(transform.parent_from_node());
      for (int k = 0; k < 16; ++k)
        if (!std::isfinite(copies.back()[k / 4][k % 4]))
          fail("the transform of instance " + std::to_string(i) + " is not finite", gltf_.file, place_);
    }
    return copies;
  }

 private:
  std::vector<glm::vec4> values(const char* name, int components) {
    if (!attributes_.IsObject() || !attributes_.Has(name)) return {};
    const tinygltf::Value& accessor = attributes_.Get(name);
    std::vector<glm::vec4> result = read_vectors(gltf_, accessor.IsInt() ? accessor.GetNumberAsInt() : -1,
                                                 at(place_, name), {components});
    if (count_ && *count_ != result.size())
      fail(std::to_string(result.size()) + " values for " + std::to_string(*count_) + " instances",
           gltf_.file, at(place_, name));
    count_ = result.size();
    return result;
  }

  const GltfFile& gltf_;
  const std::string place_;
  tinygltf::Value attributes_;
  std::optional<size_t> count_;
};

// Transforms to the node of what it places: one, or those of EXT_mesh_gpu_instancing.
std::vector<glm::dmat4> read_copies(const GltfFile& gltf, size_t node) {
  const auto& extensions = gltf.model.nodes[node].extensions;
  const auto found = extensions.find("EXT_mesh_gpu_instancing");
  if (found == extensions.end()) return {glm::dmat4(1.0)};
  return CopyReader(gltf, node, found->second).read();
}

// How far a transform is from flattening space: |det| over the product of its axes' lengths, in [0, 1].
double regularity(const glm::dmat3& m) {
  const double lengths = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
  return lengths > 0 ? std::abs(glm::determinant(m)) / lengths : 0.0;
}

bool may_deform(const tinygltf::Primitive& primitive, const tinygltf::Node& node) {
  return !primitive.targets.empty() || (node.skin >= 0 && primitive.attributes.count("JOINTS_0") > 0);
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
      if (node.mesh < 0 || !placed.ever_visible) continue;
      if (static_cast<size_t>(node.mesh) >= gltf_.model.meshes.size())
        fail("no mesh " + std::to_string(node.mesh) + "; there are " +
                 std::to_string(gltf_.model.meshes.size()),
             gltf_.file, at(at("/nodes", placed.node), "mesh"));
      const auto mesh = static_cast<size_t>(node.mesh);
      const std::vector<glm::dmat4> copies = read_copies(gltf_, placed.node);
      for (size_t i = 0; i < gltf_.model.meshes[mesh].primitives.size(); ++i) {
        if (may_deform(gltf_.model.meshes[mesh].primitives[i], node) &&
            place_deformed(mesh, i, nodes, n, copies))
          continue;
        const std::optional<uint32_t> shape = read(mesh, i);
        for (const glm::dmat4& copy : copies)
          if (shape) place(*shape, placed, n, copy);
      }
    }
  }

 private:
  // `index`: of `placed`.
  void place(uint32_t shape, const PlacedNode& placed, size_t index, glm::dmat4 node_from_object) {
    if (scene_.instances.size() >= kMaxInstances)
      fail("more than " + std::to_string(kMaxInstances) + " instances", gltf_.file,
           at("/nodes", placed.node));
    const std::string& name = gltf_.model.nodes[placed.node].name;
    const glm::dmat4 world_from_object = node_from_object == glm::dmat4(1.0)
                                             ? placed.world_from_node  // to the bit
                                             : placed.world_from_node * node_from_object;
    Instance instance{name.empty() ? scene_.meshes[shape].name : name, shape, world_from_object,
                      placed.moving, placed.visible};
    const glm::dmat3 axes(instance.world_from_object);
    if (regularity(axes) < 1e-9) {
      if (!flatten(instance, placed.node)) return;
    } else if (glm::determinant(axes) < 0) {
      instance.mesh = mirror(shape);
      instance.world_from_object[0] = -instance.world_from_object[0];
      node_from_object[0] = -node_from_object[0];
    }
    if (instance.moving)
      animation_->instances.push_back(
          {static_cast<uint32_t>(scene_.instances.size()), index, node_from_object});
    scene_.instances.push_back(std::move(instance));
  }

  // A mesh of its own for a node whose morph targets or skin shape it; false when nothing does. It moves when
  // some animation changes its shape.
  bool place_deformed(size_t mesh, size_t primitive, const std::vector<PlacedNode>& nodes, size_t index,
                      const std::vector<glm::dmat4>& copies) {
    std::optional<Mesh> raw = read_raw_primitive(gltf_, mesh, primitive, scene_.warnings);
    if (!raw) return true;
    std::optional<Deformation> deformation =
        read_deformation(gltf_, nodes, index, primitive, *raw, scene_.warnings);
    if (!deformation) return false;
    const PlacedNode& placed = nodes[index];
    const bool skinned = !deformation->joints.empty();
    // A skin stands where its first joint does, so that far origins lose no digits.
    PlacedNode place_of_skin{placed.node, {}, {}, glm::dmat4(1.0), false, true, placed.visible, true, false};
    if (skinned) {
      place_of_skin.world_from_node[3] = nodes[deformation->joints[0].node].world_from_node[3];
      deformation->mesh_from_world = glm::inverse(place_of_skin.world_from_node);
    }
    const bool mirrors = !skinned && glm::determinant(glm::dmat3(placed.world_from_node)) < 0;
    if (mirrors) mirror(*raw, *deformation);
    std::vector<uint32_t> origins;
    const bool moving = deforms(*deformation, nodes);
    const Shape shape = first_shape(*deformation, nodes, raw->indices);
    raw->positions = shape.positions;
    if (!raw->normals.empty()) raw->normals = shape.normals;
    if (!clean_primitive(gltf_, mesh, primitive, *raw, moving ? &origins : nullptr, scene_.warnings))
      return true;
    deformation->mesh = add(std::move(*raw));
    const uint32_t first = static_cast<uint32_t>(scene_.instances.size());
    glm::dmat4 unmirrored(1.0);
    if (mirrors) unmirrored[0] = -unmirrored[0];
    if (skinned)
      place(deformation->mesh, place_of_skin, index, glm::dmat4(1.0));
    else
      for (const glm::dmat4& copy : copies) place(deformation->mesh, placed, index, copy * unmirrored);
    if (skinned && placed.blinks && first < scene_.instances.size()) {
      animation_->blinking.push_back({first, index});
      scene_.instances[first].moving = true;
    }
    if (!moving) return true;
    for (size_t i = first; i < scene_.instances.size(); ++i) scene_.instances[i].moving = true;
    follow(*deformation, origins);
    animation_->deformations.push_back(std::move(*deformation));
    return true;
  }

  bool deforms(const Deformation& deformation, const std::vector<PlacedNode>& nodes) const {
    if (animation_ == nullptr) return false;
    if (deformation.node && !deformation.targets.empty() && animation_->nodes[*deformation.node].weights)
      return true;
    return std::any_of(deformation.joints.begin(), deformation.joints.end(),
                       [&](const Joint& joint) { return nodes[joint.node].moving; });
  }

  // At time 0.
  Shape first_shape(const Deformation& deformation, const std::vector<PlacedNode>& nodes,
                    const std::vector<uint32_t>& indices) const {
    std::vector<glm::dmat4> world;
    for (const PlacedNode& placed : nodes) world.push_back(placed.world_from_node);
    if (animation_ != nullptr) return shape_at(deformation, *animation_, world, 0, indices);
    std::vector<glm::dmat4> joints;
    for (const Joint& joint : deformation.joints) joints.push_back(world[joint.node]);
    return shape_of(deformation, deformation.weights, joints, indices);
  }

  static void mirror(Mesh& mesh, Deformation& deformation) {
    mesh = mirrored(mesh);
    deformation.positions = mesh.positions, deformation.normals = mesh.normals;
    for (MorphTarget& target : deformation.targets) {
      for (glm::vec3& p : target.positions) p.x = -p.x;
      for (glm::vec3& n : target.normals) n.x = -n.x;
    }
  }

  // Cleaning has moved the mesh's vertices.
  static void follow(Deformation& deformation, const std::vector<uint32_t>& origins) {
    const auto pick = [&](auto& values, size_t each) {
      if (values.empty()) return;
      auto kept = values;
      kept.clear();
      for (const uint32_t origin : origins)
        for (size_t k = 0; k < each; ++k) kept.push_back(values[origin * each + k]);
      values = std::move(kept);
    };
    pick(deformation.positions, 1);
    pick(deformation.normals, 1);
    for (MorphTarget& target : deformation.targets) pick(target.positions, 1), pick(target.normals, 1);
    pick(deformation.joint_of, deformation.influences);
    pick(deformation.weight_of, deformation.influences);
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

}  // namespace

void read_instances(const GltfFile& gltf, const std::vector<PlacedNode>& nodes, Scene& scene,
                    Animation* animation) {
  InstanceReader(gltf, scene, animation).read(nodes);
}

}  // namespace gnomon
