// Reads the animations of a glTF file.
#include "engine/scene/gltf_animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "engine/base/error.h"
#include "engine/scene/gltf_accessor.h"

namespace gnomon {
namespace {

// What a channel animates: a property, and the index of the node, light or material that has it.
struct Target {
  std::string property;  // one of kProperties'
  size_t index = 0;
};

struct Property {
  const char *collection, *path;  // as in a pointer: /collection/index/path
  const char* property;
};
constexpr const char* kLights = "extensions/KHR_lights_punctual/lights";
constexpr std::array kProperties = {
    Property{"nodes", "translation", "translation"},
    Property{"nodes", "rotation", "rotation"},
    Property{"nodes", "scale", "scale"},
    Property{"nodes", "weights", "weights"},
    Property{"nodes", "extensions/KHR_node_visibility/visible", "visible"},
    Property{kLights, "intensity", "intensity"},
    Property{"materials", "pbrMetallicRoughness/baseColorFactor", "color"},
    Property{"materials", "extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", "color"},
    Property{"materials", "alphaCutoff", "cutoff"}};

// The target of KHR_animation_pointer's pointer; nothing for what is not animated.
std::optional<Target> target_of(const std::string& pointer) {
  for (const Property& p : kProperties) {
    const std::string start = std::string("/") + p.collection + "/", end = std::string("/") + p.path;
    if (pointer.size() <= start.size() + end.size() || pointer.rfind(start, 0) != 0 ||
        pointer.compare(pointer.size() - end.size(), end.size(), end) != 0)
      continue;
    const std::string index = pointer.substr(start.size(), pointer.size() - start.size() - end.size());
    if (index.size() > 9 || index.find_first_not_of("0123456789") != std::string::npos) continue;
    return Target{p.property, static_cast<size_t>(std::stoul(index))};
  }
  return {};
}

int components_of(const std::string& property) {
  if (property == "rotation" || property == "color") return 4;
  return property == "translation" || property == "scale" ? 3 : 1;
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
      AnimatedNode node;
      node.parent = placed.parent, node.rest = placed.local, node.visible = placed.shows_itself;
      result_->nodes.push_back(std::move(node));
    }
  }

  GltfAnimation read() {
    for (size_t a = 0; a < gltf_.model.animations.size(); ++a) {
      const auto& channels = gltf_.model.animations[a].channels;
      for (size_t c = 0; c < channels.size(); ++c)
        read_channel(gltf_.model.animations[a], channels[c], at(at(at("/animations", a), "channels"), c),
                     at("/animations", a));
    }
    settle();
    return {result_, std::move(intensities_)};
  }

 private:
  void warn(const std::string& place, const std::string& what) {
    warnings_.messages.push_back(gltf_.file + ": " + place + ": " + what);
  }

  void read_channel(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& channel,
                    const std::string& place, const std::string& animation_place) {
    const std::optional<Target> target = target_at(channel, place);
    if (!target) return;
    if (channel.sampler < 0 || static_cast<size_t>(channel.sampler) >= animation.samplers.size())
      fail("no sampler " + std::to_string(channel.sampler) + "; there are " +
               std::to_string(animation.samplers.size()),
           gltf_.file, at(place, "sampler"));
    const auto sampler = static_cast<size_t>(channel.sampler);
    const std::string sampler_place = at(at(animation_place, "samplers"), sampler);
    if (target->property == "intensity" || target->property == "color" || target->property == "cutoff")
      return read_other(*target, animation.samplers[sampler], sampler_place, place);
    read_node(*target, animation.samplers[sampler], sampler_place, place);
  }

  // Nothing, with a warning where it is of something, for what is not animated.
  std::optional<Target> target_at(const tinygltf::AnimationChannel& channel, const std::string& place) {
    if (channel.target_path == "pointer") {
      const auto extension = channel.target_extensions.find("KHR_animation_pointer");
      const bool has = extension != channel.target_extensions.end() && extension->second.Has("pointer");
      const tinygltf::Value value = has ? extension->second.Get("pointer") : tinygltf::Value();
      const std::string pointer = value.IsString() ? value.Get<std::string>() : "";
      std::optional<Target> target = target_of(pointer);
      if (!target) warn(at(place, "target"), "'" + pointer + "' is not animated; shadows can differ");
      return target;
    }
    if (channel.target_node < 0) return {};  // glTF 2.0, 3.11: to be ignored
    const std::string& path = channel.target_path;
    if (path == "translation" || path == "rotation" || path == "scale" || path == "weights")
      return Target{path, static_cast<size_t>(channel.target_node)};
    warn(at(place, "target/path"), "'" + path + "' is not animated");
    return {};
  }

  // `whose`: "node 3's".
  template <typename Value>
  void keep(std::optional<Value>& track, const std::string& whose, const Target& target,
            const std::string& place, Value read) {
    if (track)
      return warn(place, whose + " " + target.property + " is animated already: this channel is ignored");
    track = std::move(read);
  }

  void read_node(const Target& target, const tinygltf::AnimationSampler& sampler,
                 const std::string& sampler_place, const std::string& place) {
    if (target.index >= gltf_.model.nodes.size())
      fail("no node " + std::to_string(target.index) + "; there are " +
               std::to_string(gltf_.model.nodes.size()),
           gltf_.file, at(place, "target/node"));
    const auto found = index_.find(target.index);
    if (found == index_.end()) return;  // not in the scene
    AnimatedNode& node = result_->nodes[found->second];
    const std::string whose = "node " + std::to_string(target.index) + "'s";
    if (target.property == "weights" && !morphs(target.index))
      return warn(at(place, "target/path"), "'weights' of a node without morph targets");
    if (target.property == "weights")
      return keep(node.weights, whose, target, place, read_weights(sampler, sampler_place));
    if (target.property != "visible" && node.rest.matrix)
      return warn(place, "node " + std::to_string(target.index) + " has a matrix: its animation is ignored");
    std::optional<Track>& track = target.property == "translation" ? node.translation
                                  : target.property == "rotation"  ? node.rotation
                                  : target.property == "scale"     ? node.scale
                                                                   : node.visibility;
    keep(track, whose, target, place, read_track(sampler, target.property, sampler_place));
    if (target.property == "visible") track->interpolation = Interpolation::step;
  }

  bool morphs(size_t node) const {
    const int mesh = gltf_.model.nodes[node].mesh;
    if (mesh < 0 || static_cast<size_t>(mesh) >= gltf_.model.meshes.size()) return false;
    const auto& primitives = gltf_.model.meshes[static_cast<size_t>(mesh)].primitives;
    return std::any_of(primitives.begin(), primitives.end(),
                       [](const tinygltf::Primitive& p) { return !p.targets.empty(); });
  }

  // Of lights and materials.
  void read_other(const Target& target, const tinygltf::AnimationSampler& sampler,
                  const std::string& sampler_place, const std::string& place) {
    const Track track = read_track(sampler, target.property, sampler_place);
    const bool light = target.property == "intensity";
    const size_t count = light ? gltf_.model.lights.size() : gltf_.model.materials.size();
    if (target.index >= count)
      fail("no " + std::string(light ? "light " : "material ") + std::to_string(target.index) +
               "; there are " + std::to_string(count),
           gltf_.file, at(place, "target"));
    if (light) {
      if (!intensities_.emplace(target.index, track).second)
        warn(place, "the light's intensity is animated already: this channel is ignored");
      return;
    }
    auto& materials = result_->changing_materials;
    auto found = std::find_if(materials.begin(), materials.end(),
                              [&](const ChangingMaterial& m) { return m.material == target.index; });
    if (found == materials.end()) {
      materials.push_back({static_cast<uint32_t>(target.index), glm::vec4(1.0f), 0.5f, {}, {}});
      found = materials.end() - 1;
    }
    keep(target.property == "color" ? found->color : found->cutoff,
         "material " + std::to_string(target.index) + "'s", target, place, track);
  }

  Interpolation interpolation_of(const tinygltf::AnimationSampler& sampler, const std::string& place) const {
    if (sampler.interpolation == "STEP") return Interpolation::step;
    if (sampler.interpolation == "CUBICSPLINE") return Interpolation::cubic_spline;
    if (sampler.interpolation != "LINEAR")
      fail("unknown interpolation '" + sampler.interpolation + "'", gltf_.file, at(place, "interpolation"),
           "LINEAR, STEP or CUBICSPLINE");
    return Interpolation::linear;
  }

  Track read_track(const tinygltf::AnimationSampler& sampler, const std::string& property,
                   const std::string& place) const {
    Track track;
    track.interpolation = interpolation_of(sampler, place);
    read_times(sampler, at(place, "input"), track.times);
    read_values(sampler, property, at(place, "output"), track);
    return track;
  }

  WeightTrack read_weights(const tinygltf::AnimationSampler& sampler, const std::string& place) const {
    WeightTrack track;
    track.interpolation = interpolation_of(sampler, place);
    read_times(sampler, at(place, "input"), track.times);
    for (const glm::vec4& v : read_vectors(gltf_, sampler.output, at(place, "output"), {1})) {
      if (!std::isfinite(v.x)) fail("a weight is not finite", gltf_.file, at(place, "output"));
      track.values.push_back(v.x);
    }
    const size_t parts = (track.interpolation == Interpolation::cubic_spline ? 3 : 1) * track.times.size();
    track.count = track.values.size() / parts;
    if (track.count * parts != track.values.size())
      fail(std::to_string(track.times.size()) + " key frames do not divide " +
               std::to_string(track.values.size()) + " weights",
           gltf_.file, at(place, "output"));
    return track;
  }

  void read_times(const tinygltf::AnimationSampler& sampler, const std::string& place,
                  std::vector<double>& times) const {
    for (const glm::vec4& v : read_vectors(gltf_, sampler.input, place, {1})) times.push_back(v.x);
    if (times.empty()) fail("no key frames", gltf_.file, place);
    for (size_t i = 0; i < times.size(); ++i) {
      const std::string which = "the time of key frame " + std::to_string(i);
      if (!std::isfinite(times[i]) || times[i] < 0)
        fail(which + " is not a finite number from 0", gltf_.file, place);
      if (i > 0 && times[i] <= times[i - 1]) fail(which + " is not after the one before", gltf_.file, place);
    }
  }

  void read_values(const tinygltf::AnimationSampler& sampler, const std::string& property,
                   const std::string& place, Track& track) const {
    const bool rotation = property == "rotation";
    for (const glm::vec4& v : read_vectors(gltf_, sampler.output, place, {components_of(property)}))
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
      if (constant(node.visibility))
        node.visible = values_at(*node.visibility, 0).x != 0, node.visibility.reset();
      node.moving = node.translation || node.rotation || node.scale || node.visibility ||
                    (node.parent && result_->nodes[*node.parent].moving);
    }
  }

  const GltfFile& gltf_;
  SceneWarnings& warnings_;
  std::shared_ptr<Animation> result_;
  std::map<size_t, size_t> index_;  // of the file's nodes in the result
  std::map<size_t, Track> intensities_;
};

// Whether a node shows at time 0, ever, and changes that.
void mark_visibility(const Animation& animation, std::vector<PlacedNode>& nodes) {
  const std::vector<bool> visible = node_visibility(animation, 0);
  for (size_t i = 0; i < nodes.size(); ++i) {
    const AnimatedNode& node = animation.nodes[i];
    const PlacedNode* parent = node.parent ? &nodes[*node.parent] : nullptr;
    nodes[i].visible = visible[i];
    nodes[i].blinks = node.visibility || (parent != nullptr && parent->blinks);
    nodes[i].ever_visible = (node.visible || node.visibility) && (parent == nullptr || parent->ever_visible);
  }
}

}  // namespace

GltfAnimation read_animation(const GltfFile& gltf, std::vector<PlacedNode>& nodes, SceneWarnings& warnings) {
  if (gltf.model.animations.empty()) return {};
  GltfAnimation result = AnimationReader(gltf, nodes, warnings).read();
  const Animation& animation = *result.animation;
  const std::vector<glm::dmat4> world = node_transforms(animation, 0);
  bool any = !animation.changing_materials.empty() || !result.intensities.empty();
  for (size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].world_from_node = world[i];
    nodes[i].moving = animation.nodes[i].moving;
    any = any || nodes[i].moving || animation.nodes[i].weights;
    for (int k = 0; k < 16; ++k)
      if (!std::isfinite(world[i][k / 4][k % 4]))
        fail("its transform to the world is not finite", gltf.file, at("/nodes", nodes[i].node));
  }
  mark_visibility(animation, nodes);
  if (!any) result.animation = nullptr;
  return result;
}

}  // namespace gnomon
