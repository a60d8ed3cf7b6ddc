// Reads the animations of a glTF file.
#include "engine/scene/gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/base/error.h"
#include "engine/scene/gltf_accessor.h"

namespace gnomon {
namespace {

using Tracks = std::optional<Track> AnimatedNode::*;

Tracks property_of(const std::string& path) {
  if (path == "translation") return &AnimatedNode::translation;
  if (path == "rotation") return &AnimatedNode::rotation;
  return path == "scale" ? &AnimatedNode::scale : nullptr;
}

// One value at all key frames, and no tangent that leads away from it.
bool is_constant(const Track& track) {
  const bool cubic = track.interpolation == Interpolation::cubic_spline;
  const glm::dvec4 first = track.values[cubic ? 1 : 0];
  for (size_t i = 0; i < track.values.size(); ++i)
    if (track.values[i] != (cubic && i % 3 != 1 ? glm::dvec4(0.0) : first)) return false;
  return true;
}

class AnimationReader {
 public:
  AnimationReader(const GltfFile& gltf, const std::vector<PlacedNode>& nodes, SceneWarnings& warnings)
      : gltf_(gltf), warnings_(warnings), result_(std::make_shared<Animation>()) {
    for (const PlacedNode& placed : nodes) {
      index_[placed.node] = result_->nodes.size();
      result_->nodes.push_back({placed.parent, placed.local, {}, {}, {}, false});
    }
  }

  std::shared_ptr<Animation> read() {
    for (size_t a = 0; a < gltf_.model.animations.size(); ++a) {
      const auto& channels = gltf_.model.animations[a].channels;
      for (size_t c = 0; c < channels.size(); ++c)
        read_channel(gltf_.model.animations[a], channels[c], at(at(at("/animations", a), "channels"), c),
                     at("/animations", a));
    }
    settle();
    return result_;
  }

 private:
  void warn(const std::string& place, const std::string& what) {
    warnings_.messages.push_back(gltf_.file + ": " + place + ": " + what);
  }

  void read_channel(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& channel,
                    const std::string& place, const std::string& animation_place) {
    if (channel.target_node < 0) return;  // glTF 2.0, 3.11: to be ignored
    const auto node = static_cast<size_t>(channel.target_node);
    if (node >= gltf_.model.nodes.size())
      fail("no node " + std::to_string(channel.target_node) + "; there are " +
               std::to_string(gltf_.model.nodes.size()),
           gltf_.file, at(place, "target/node"));
    if (channel.sampler < 0 || static_cast<size_t>(channel.sampler) >= animation.samplers.size())
      fail("no sampler " + std::to_string(channel.sampler) + "; there are " +
               std::to_string(animation.samplers.size()),
           gltf_.file, at(place, "sampler"));
    const Tracks property = property_of(channel.target_path);
    if (property == nullptr)
      return warn(at(place, "target/path"), "'" + channel.target_path + "' is not animated, only nodes move");
    const auto found = index_.find(node);
    if (found == index_.end()) return;  // not in the scene
    AnimatedNode& target = result_->nodes[found->second];
    if (target.rest.matrix)
      return warn(place, "node " + std::to_string(node) + " has a matrix: its animation is ignored");
    if (target.*property)
      return warn(place, "node " + std::to_string(node) + "'s " + channel.target_path +
                             " is animated already: this channel is ignored");
    const auto sampler = static_cast<size_t>(channel.sampler);
    target.*property = read_track(animation.samplers[sampler], property == &AnimatedNode::rotation,
                                  at(at(animation_place, "samplers"), sampler));
  }

  Track read_track(const tinygltf::AnimationSampler& sampler, bool rotation, const std::string& place) const {
    Track track;
    if (sampler.interpolation == "STEP")
      track.interpolation = Interpolation::step;
    else if (sampler.interpolation == "CUBICSPLINE")
      track.interpolation = Interpolation::cubic_spline;
    else if (sampler.interpolation != "LINEAR")
      fail("unknown interpolation '" + sampler.interpolation + "'", gltf_.file, at(place, "interpolation"),
           "LINEAR, STEP or CUBICSPLINE");
    read_times(sampler, at(place, "input"), track);
    read_values(sampler, rotation, at(place, "output"), track);
    return track;
  }

  void read_times(const tinygltf::AnimationSampler& sampler, const std::string& place, Track& track) const {
    for (const glm::vec4& v : read_vectors(gltf_, sampler.input, place, {1})) track.times.push_back(v.x);
    if (track.times.empty()) fail("no key frames", gltf_.file, place);
    for (size_t i = 0; i < track.times.size(); ++i) {
      const std::string which = "the time of key frame " + std::to_string(i);
      if (!std::isfinite(track.times[i]) || track.times[i] < 0)
        fail(which + " is not a finite number from 0", gltf_.file, place);
      if (i > 0 && track.times[i] <= track.times[i - 1])
        fail(which + " is not after the one before", gltf_.file, place);
    }
  }

  void read_values(const tinygltf::AnimationSampler& sampler, bool rotation, const std::string& place,
                   Track& track) const {
    for (const glm::vec4& v : read_vectors(gltf_, sampler.output, place, {rotation ? 4 : 3}))
      track.values.push_back(glm::dvec4(v));
    const bool cubic = track.interpolation == Interpolation::cubic_spline;
    const size_t wanted = (cubic ? 3 : 1) * track.times.size();
    if (track.values.size() != wanted)
      fail(std::to_string(track.times.size()) + " key frames need " + std::to_string(wanted) +
               " values, there are " + std::to_string(track.values.size()),
           gltf_.file, place);
    for (size_t i = 0; i < track.values.size(); ++i) {
      glm::dvec4& value = track.values[i];
      const std::string which = "value " + std::to_string(i);
      for (int k = 0; k < 4; ++k)
        if (!std::isfinite(value[k]) || std::abs(value[k]) > 1e30)
          fail(which + " is not finite", gltf_.file, place);
      if (!rotation || (cubic && i % 3 != 1)) continue;
      if (glm::length(value) < 1e-12) fail(which + " is a quaternion of length 0", gltf_.file, place);
      value = glm::normalize(value);
    }
  }

  // Tracks that never change anything become the node's own transform; then, who moves?
  void settle() {
    for (AnimatedNode& node : result_->nodes) {
      const auto constant = [](const std::optional<Track>& track) { return track && is_constant(*track); };
      if (constant(node.translation))
        node.rest.translation = vector_at(*node.translation, 0), node.translation.reset();
      if (constant(node.rotation)) node.rest.rotation = rotation_at(*node.rotation, 0), node.rotation.reset();
      if (constant(node.scale)) node.rest.scale = vector_at(*node.scale, 0), node.scale.reset();
      node.moving = node.translation || node.rotation || node.scale ||
                    (node.parent && result_->nodes[*node.parent].moving);
    }
  }

  const GltfFile& gltf_;
  SceneWarnings& warnings_;
  std::shared_ptr<Animation> result_;
  std::map<size_t, size_t> index_;  // of the file's nodes in the result
};

}  // namespace

std::shared_ptr<Animation> read_animation(const GltfFile& gltf, std::vector<PlacedNode>& nodes,
                                          SceneWarnings& warnings) {
  if (gltf.model.animations.empty()) return nullptr;
  std::shared_ptr<Animation> animation = AnimationReader(gltf, nodes, warnings).read();
  const std::vector<glm::dmat4> world = node_transforms(*animation, 0);
  bool any = false;
  for (size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].world_from_node = world[i];
    nodes[i].moving = animation->nodes[i].moving;
    any = any || nodes[i].moving;
    for (int k = 0; k < 16; ++k)
      if (!std::isfinite(world[i][k / 4][k % 4]))
        fail("its transform to the world is not finite", gltf.file, at("/nodes", nodes[i].node));
  }
  return any ? animation : nullptr;
}

}  // namespace gnomon
