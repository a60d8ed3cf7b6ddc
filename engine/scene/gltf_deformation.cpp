// Reads morph targets, joints and weights.
#include "engine/scene/gltf_deformation.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "engine/base/error.h"
#include "engine/scene/gltf_accessor.h"

namespace gnomon {
namespace {

class DeformationReader {
 public:
  DeformationReader(const GltfFile& gltf, const std::vector<PlacedNode>& nodes, size_t node, size_t primitive,
                    const Mesh& mesh, SceneWarnings& warnings)
      : gltf_(gltf),
        nodes_(nodes),
        placed_(nodes[node]),
        source_(gltf.model.nodes[placed_.node]),
        mesh_(gltf.model.meshes[static_cast<size_t>(source_.mesh)]),
        primitive_(mesh_.primitives[primitive]),
        place_(at(at(at("/meshes", static_cast<size_t>(source_.mesh)), "primitives"), primitive)),
        warnings_(warnings) {
    result_.positions = mesh.positions;
    result_.normals = mesh.normals;
    result_.node = node;
  }

  std::optional<Deformation> read() {
    read_targets();
    read_skin();
    if (result_.targets.empty() && result_.joints.empty()) return {};
    return std::move(result_);
  }

 private:
  std::vector<glm::vec4> values(int accessor, const std::string& place, const std::vector<int>& components) {
    std::vector<glm::vec4> found = read_vectors(gltf_, accessor, place, components);
    if (found.size() != result_.positions.size())
      fail(std::to_string(found.size()) + " values for " + std::to_string(result_.positions.size()) +
               " vertices",
           gltf_.file, place);
    return found;
  }

  std::vector<glm::vec3> differences(const std::map<std::string, int>& target, const char* name,
                                     const std::string& place) {
    std::vector<glm::vec3> result;
    const auto found = target.find(name);
    if (found == target.end()) return result;
    for (const glm::vec4& v : values(found->second, at(place, name), {3})) {
      const bool finite = std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
      result.push_back(finite ? glm::vec3(v) : glm::vec3(0.0f));
    }
    return result;
  }

  void read_targets() {
    const std::string place = at(place_, "targets");
    for (size_t t = 0; t < primitive_.targets.size(); ++t)
      result_.targets.push_back({differences(primitive_.targets[t], "POSITION", at(place, t)),
                                 differences(primitive_.targets[t], "NORMAL", at(place, t))});
    result_.weights.assign(result_.targets.size(), 0.0);
    const std::vector<double>& weights = source_.weights.empty() ? mesh_.weights : source_.weights;
    for (size_t t = 0; t < result_.weights.size() && t < weights.size(); ++t)
      if (std::isfinite(weights[t])) result_.weights[t] = weights[t];
  }

  bool has(const std::string& name) const { return primitive_.attributes.count(name) > 0; }

  void read_skin() {
    if (source_.skin < 0 || !has("JOINTS_0") || !has("WEIGHTS_0")) return;
    if (static_cast<size_t>(source_.skin) >= gltf_.model.skins.size())
      fail("no skin " + std::to_string(source_.skin) + "; there are " +
               std::to_string(gltf_.model.skins.size()),
           gltf_.file, at(at("/nodes", placed_.node), "skin"));
    if (!read_joints(static_cast<size_t>(source_.skin))) return;
    size_t sets = 0;
    while (has("JOINTS_" + std::to_string(sets)) && has("WEIGHTS_" + std::to_string(sets))) ++sets;
    const size_t vertices = result_.positions.size();
    result_.influences = 4 * sets;
    result_.joint_of.resize(result_.influences * vertices);
    result_.weight_of.resize(result_.influences * vertices);
    for (size_t s = 0; s < sets; ++s) read_influences(s);
    for (size_t i = 0; i < vertices; ++i) normalize(i);
  }

  // False, with a warning, when the scene lacks a joint.
  bool read_joints(size_t index) {
    const tinygltf::Skin& skin = gltf_.model.skins[index];
    const std::string place = at("/skins", index);
    std::unordered_map<size_t, size_t> placed;
    for (size_t i = 0; i < nodes_.size(); ++i) placed[nodes_[i].node] = i;
    for (size_t j = 0; j < skin.joints.size(); ++j) {
      const auto found = placed.find(static_cast<size_t>(skin.joints[j]));
      if (skin.joints[j] < 0 || found == placed.end()) {
        warnings_.messages.push_back(gltf_.file + ": " + at(at(place, "joints"), j) + ": node " +
                                     std::to_string(skin.joints[j]) +
                                     " is not in the scene: the mesh stays in its bind pose");
        result_.joints.clear();
        return false;
      }
      result_.joints.push_back({found->second, glm::dmat4(1.0)});
    }
    if (result_.joints.empty()) fail("a skin without joints", gltf_.file, place);
    if (result_.joints.size() > UINT16_MAX) fail("more than 65535 joints", gltf_.file, place);
    if (skin.inverseBindMatrices < 0) return true;
    const std::vector<glm::dmat4> matrices =
        read_matrices(gltf_, skin.inverseBindMatrices, at(place, "inverseBindMatrices"));
    if (matrices.size() < result_.joints.size())
      fail(std::to_string(matrices.size()) + " inverse bind matrices for " +
               std::to_string(result_.joints.size()) + " joints",
           gltf_.file, place);
    for (size_t j = 0; j < result_.joints.size(); ++j) result_.joints[j].joint_from_mesh = matrices[j];
    return true;
  }

  void read_influences(size_t set) {
    const std::string number = std::to_string(set), place = at(place_, "attributes");
    const std::string joints = "JOINTS_" + number, weights = "WEIGHTS_" + number;
    const auto indices = values(primitive_.attributes.at(joints), at(place, joints), {4});
    const auto shares = values(primitive_.attributes.at(weights), at(place, weights), {4});
    for (size_t i = 0; i < indices.size(); ++i)
      for (int c = 0; c < 4; ++c) {
        const float share = shares[i][c], joint = indices[i][c];
        const size_t k = i * result_.influences + 4 * set + static_cast<size_t>(c);
        if (!(share > 0) || !std::isfinite(share)) continue;
        if (!(joint >= 0) || joint >= static_cast<float>(result_.joints.size()))
          fail("joint " + std::to_string(joint) + " of vertex " + std::to_string(i) +
                   " is out of range; there are " + std::to_string(result_.joints.size()),
               gltf_.file, at(place, joints));
        result_.joint_of[k] = static_cast<uint16_t>(joint);
        result_.weight_of[k] = share;
      }
  }

  // A vertex without weights hangs on the first joint.
  void normalize(size_t vertex) {
    float* weights = &result_.weight_of[vertex * result_.influences];
    double sum = 0;
    for (size_t k = 0; k < result_.influences; ++k) sum += weights[k];
    if (!(sum > 0)) weights[0] = 1, sum = 1;
    for (size_t k = 0; k < result_.influences; ++k) weights[k] = static_cast<float>(weights[k] / sum);
  }

  const GltfFile& gltf_;
  const std::vector<PlacedNode>& nodes_;
  const PlacedNode& placed_;
  const tinygltf::Node& source_;
  const tinygltf::Mesh& mesh_;
  const tinygltf::Primitive& primitive_;
  const std::string place_;
  SceneWarnings& warnings_;
  Deformation result_;
};

}  // namespace

std::optional<Deformation> read_deformation(const GltfFile& gltf, const std::vector<PlacedNode>& nodes,
                                            size_t node, size_t primitive, const Mesh& mesh,
                                            SceneWarnings& warnings) {
  return DeformationReader(gltf, nodes, node, primitive, mesh, warnings).read();
}

}  // namespace gnomon
