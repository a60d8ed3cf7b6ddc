// Walks a glTF file's node tree: transforms, and what is not supported.
#include "engine/scene/scene_nodes.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"

namespace gnomon {
namespace {

void check_length(const GltfFile& gltf, const std::vector<double>& values, size_t length,
                  const std::string& place) {
  if (!values.empty() && values.size() != length)
    fail("must have " + std::to_string(length) + " numbers, has " + std::to_string(values.size()), gltf.file,
         place);
  for (const double value : values)
    if (!std::isfinite(value) || std::abs(value) > 1e30) fail("is not finite", gltf.file, place);
}

NodeTransform local_transform(const GltfFile& gltf, size_t index, SceneWarnings& warnings) {
  const tinygltf::Node& node = gltf.model.nodes[index];
  const std::string place = at("/nodes", index);
  check_length(gltf, node.matrix, 16, at(place, "matrix"));
  check_length(gltf, node.translation, 3, at(place, "translation"));
  check_length(gltf, node.rotation, 4, at(place, "rotation"));
  check_length(gltf, node.scale, 3, at(place, "scale"));
  NodeTransform result;
  if (!node.matrix.empty()) {
    glm::dmat4 m;
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[static_cast<size_t>(i)];
    m[0].w = m[1].w = m[2].w = 0.0, m[3].w = 1.0;
    result.matrix = m;
    return result;
  }
  if (!node.translation.empty())
    result.translation = {node.translation[0], node.translation[1], node.translation[2]};
  if (!node.rotation.empty()) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (glm::length(q) > 1e-12)
      result.rotation = glm::normalize(q);
    else
      warnings.messages.push_back(gltf.file + ": " + at(place, "rotation") +
                                  ": a quaternion of length 0 is ignored");
  }
  if (!node.scale.empty()) result.scale = {node.scale[0], node.scale[1], node.scale[2]};
  return result;
}

bool shows_itself(const tinygltf::Node& node) {
  const auto found = node.extensions.find("KHR_node_visibility");
  if (found == node.extensions.end() || !found->second.Has("visible")) return true;
  const tinygltf::Value& visible = found->second.Get("visible");
  return !visible.IsBool() || visible.Get<bool>();
}

const tinygltf::Scene* default_scene(const GltfFile& gltf) {
  const auto& scenes = gltf.model.scenes;
  if (gltf.model.defaultScene >= 0 && static_cast<size_t>(gltf.model.defaultScene) >= scenes.size())
    fail("no scene " + std::to_string(gltf.model.defaultScene) + "; there are " +
             std::to_string(scenes.size()),
         gltf.file, "/scene");
  if (scenes.empty()) return nullptr;
  return &scenes[static_cast<size_t>(std::max(gltf.model.defaultScene, 0))];
}

std::vector<int> root_nodes(const GltfFile& gltf) {
  if (const tinygltf::Scene* scene = default_scene(gltf)) return scene->nodes;
  std::vector<bool> child(gltf.model.nodes.size(), false);
  for (const auto& node : gltf.model.nodes)
    for (const int c : node.children)
      if (c >= 0 && static_cast<size_t>(c) < child.size()) child[static_cast<size_t>(c)] = true;
  std::vector<int> roots;
  for (size_t i = 0; i < child.size(); ++i)
    if (!child[i]) roots.push_back(static_cast<int>(i));
  return roots;
}

}  // namespace

const tinygltf::Value& scene_extras(const GltfFile& gltf) {
  static const tinygltf::Value none;
  const tinygltf::Scene* scene = default_scene(gltf);
  return scene == nullptr ? none : scene->extras;
}

std::vector<PlacedNode> walk_nodes(const GltfFile& gltf, SceneWarnings& warnings) {
  struct Pending {
    int node;
    std::optional<size_t> parent;
    std::string place;
  };
  std::vector<Pending> stack;
  const std::vector<int> roots = root_nodes(gltf);
  for (size_t i = roots.size(); i-- > 0;) stack.push_back({roots[i], {}, "/scenes/nodes"});
  std::vector<bool> seen(gltf.model.nodes.size(), false);
  std::vector<PlacedNode> placed;
  while (!stack.empty()) {
    const Pending pending = std::move(stack.back());
    stack.pop_back();
    if (pending.node < 0 || static_cast<size_t>(pending.node) >= seen.size())
      fail("no node " + std::to_string(pending.node) + "; there are " + std::to_string(seen.size()),
           gltf.file, pending.place);
    const size_t index = static_cast<size_t>(pending.node);
    if (seen[index])
      fail("the node is reached twice: the nodes are not a tree", gltf.file, at("/nodes", index));
    seen[index] = true;
    const NodeTransform local = local_transform(gltf, index, warnings);
    const glm::dmat4 to_parent = local.parent_from_node();
    const glm::dmat4 world = pending.parent ? placed[*pending.parent].world_from_node * to_parent : to_parent;
    const bool itself = shows_itself(gltf.model.nodes[index]);
    const bool visible = itself && (!pending.parent || placed[*pending.parent].visible);
    placed.push_back({index, pending.parent, local, world, false, itself, visible, visible, false});
    for (int i = 0; i < 16; ++i)
      if (!std::isfinite(world[i / 4][i % 4]))
        fail("its transform to the world is not finite", gltf.file, at("/nodes", index));
    const auto& children = gltf.model.nodes[index].children;
    for (size_t i = children.size(); i-- > 0;)
      stack.push_back({children[i], placed.size() - 1, at(at("/nodes", index), "children")});
  }
  return placed;
}

glm::dmat4 looking_at(const glm::dvec3& eye, const glm::dvec3& target) {
  glm::dmat4 frame(1.0);
  frame[2] = glm::dvec4(eye - target, 0.0);
  frame[3] = glm::dvec4(eye, 1.0);
  return rigid(frame);
}

}  // namespace gnomon
