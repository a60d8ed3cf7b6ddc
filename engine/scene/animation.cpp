// Interpolates key frames and poses a scene's node tree at a time.
#include "engine/scene/animation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon {
namespace {

// The key frames around a time, and where it lies between them.
struct Segment {
  size_t before = 0, after = 0;  // equal: outside the key frames, or on one
  double share = 0;              // 0 at `before`, 1 at `after`
  double length = 0;             // seconds
};

Segment segment_at(const std::vector<double>& times, double seconds) {
  if (!(seconds > times.front())) return {};
  if (seconds >= times.back()) return {times.size() - 1, times.size() - 1, 0, 0};
  const auto next = std::upper_bound(times.begin(), times.end(), seconds);
  const auto after = static_cast<size_t>(next - times.begin());
  const double start = times[after - 1], length = times[after] - start;
  return {after - 1, after, (seconds - start) / length, length};
}

const glm::dvec4& value_of(const Track& track, size_t key) {
  return track.values[track.interpolation == Interpolation::cubic_spline ? 3 * key + 1 : key];
}

// Hermite basis (glTF 2.0, C.5); tangents are per second.
glm::dvec4 spline(const Track& track, const Segment& s) {
  const double t = s.share, t2 = t * t, t3 = t2 * t;
  const glm::dvec4 &from = value_of(track, s.before), &to = value_of(track, s.after);
  const glm::dvec4 &leaving = track.values[3 * s.before + 2], &arriving = track.values[3 * s.after];
  return (2 * t3 - 3 * t2 + 1) * from + s.length * (t3 - 2 * t2 + t) * leaving + (3 * t2 - 2 * t3) * to +
         s.length * (t3 - t2) * arriving;
}

bool holds(const Track& track, const Segment& s) {
  return s.before == s.after || track.interpolation == Interpolation::step;
}

glm::dquat quaternion(const glm::dvec4& v) { return {v.w, v.x, v.y, v.z}; }

// `moving`: scales are kept away from 0.
NodeTransform transform_at(const AnimatedNode& node, double seconds) {
  NodeTransform result = node.rest;
  if (node.translation) result.translation = vector_at(*node.translation, seconds);
  if (node.rotation) result.rotation = rotation_at(*node.rotation, seconds);
  if (node.scale) result.scale = vector_at(*node.scale, seconds);
  if (node.moving)
    for (int i = 0; i < 3; ++i)
      if (std::abs(result.scale[i]) < kSmallestScale)
        result.scale[i] = std::copysign(kSmallestScale, result.scale[i]);
  return result;
}

}  // namespace

glm::dvec4 values_at(const Track& track, double seconds) {
  const Segment s = segment_at(track.times, seconds);
  const glm::dvec4& from = value_of(track, s.before);
  if (holds(track, s)) return from;
  if (track.interpolation == Interpolation::cubic_spline) return spline(track, s);
  return glm::mix(from, value_of(track, s.after), s.share);
}

glm::dvec3 vector_at(const Track& track, double seconds) { return glm::dvec3(values_at(track, seconds)); }

std::vector<double> weights_at(const WeightTrack& track, double seconds) {
  // One weight after the other, as a track of its own.
  const size_t parts = track.interpolation == Interpolation::cubic_spline ? 3 : 1;
  std::vector<double> result(track.count);
  Track one{track.interpolation, track.times, std::vector<glm::dvec4>(parts * track.times.size())};
  for (size_t w = 0; w < track.count; ++w) {
    for (size_t i = 0; i < one.values.size(); ++i) one.values[i].x = track.values[i * track.count + w];
    result[w] = values_at(one, seconds).x;
  }
  return result;
}

glm::dquat rotation_at(const Track& track, double seconds) {
  const Segment s = segment_at(track.times, seconds);
  const glm::dquat from = quaternion(value_of(track, s.before));
  if (holds(track, s)) return from;
  if (track.interpolation == Interpolation::linear)
    return glm::normalize(glm::slerp(from, quaternion(value_of(track, s.after)), s.share));
  const glm::dquat q = quaternion(spline(track, s));
  const double length = glm::length(q);
  return length > 1e-12 ? q / length : from;  // tangents may lead through 0
}

glm::dmat4 NodeTransform::parent_from_node() const {
  if (matrix) return *matrix;
  glm::dmat4 result = glm::translate(glm::dmat4(1.0), translation);
  result *= glm::mat4_cast(rotation);
  return glm::scale(result, scale);
}

std::vector<glm::dmat4> node_transforms(const Animation& animation, double seconds) {
  std::vector<glm::dmat4> world;
  world.reserve(animation.nodes.size());
  for (const AnimatedNode& node : animation.nodes) {
    const glm::dmat4 local = transform_at(node, seconds).parent_from_node();
    world.push_back(node.parent ? world[*node.parent] * local : local);
  }
  return world;
}

bool is_idle(const Animation& a) {
  return a.instances.empty() && a.cameras.empty() && a.lights.empty() && a.blinking.empty() &&
         a.changing_lights.empty() && a.changing_materials.empty() && a.deformations.empty();
}

std::vector<bool> node_visibility(const Animation& animation, double seconds) {
  std::vector<bool> visible;
  visible.reserve(animation.nodes.size());
  for (const AnimatedNode& node : animation.nodes) {
    const bool itself = node.visibility ? values_at(*node.visibility, seconds).x != 0 : node.visible;
    visible.push_back(itself && (!node.parent || visible[*node.parent]));
  }
  return visible;
}

Shape shape_at(const Deformation& deformation, const Animation& animation,
               const std::vector<glm::dmat4>& world_from_node, double seconds,
               std::span<const uint32_t> indices) {
  std::vector<double> weights = deformation.weights;
  if (deformation.node)
    if (const auto& track = animation.nodes[*deformation.node].weights) weights = weights_at(*track, seconds);
  std::vector<glm::dmat4> joints;
  for (const Joint& joint : deformation.joints) joints.push_back(world_from_node[joint.node]);
  return shape_of(deformation, weights, joints, indices);
}

double duration(const Animation& animation) {
  double last = 0;
  const auto reach = [&](const auto& track) {
    if (track) last = std::max(last, track->times.back());
  };
  for (const AnimatedNode& node : animation.nodes) {
    for (const auto* track : {&node.translation, &node.rotation, &node.scale, &node.visibility})
      reach(*track);
    reach(node.weights);
  }
  for (const ChangingLight& light : animation.changing_lights) reach(light.track);
  for (const ChangingMaterial& material : animation.changing_materials)
    reach(material.color), reach(material.cutoff);
  return last;
}

namespace {

// What changes without moving.
void change(const Scene& scene, const Animation& animation, const std::vector<glm::dmat4>& world,
            double seconds, Pose& pose) {
  const std::vector<bool> visible = node_visibility(animation, seconds);
  for (const Attachment& a : animation.instances) pose.visible[a.target] = visible[a.node];
  for (const BlinkingInstance& b : animation.blinking) pose.visible[b.instance] = visible[b.node];
  for (const ChangingLight& light : animation.changing_lights) {
    const double lit = light.track ? std::max(values_at(*light.track, seconds).x, 0.0) : light.intensity;
    pose.intensities[light.light] = light.node && !visible[*light.node] ? 0.0 : lit;
  }
  for (const ChangingMaterial& m : animation.changing_materials)
    pose.materials.push_back(
        {m.material, m.color ? glm::clamp(glm::vec4(values_at(*m.color, seconds)), 0.0f, 1.0f) : m.base_color,
         m.cutoff ? static_cast<float>(values_at(*m.cutoff, seconds).x) : m.alpha_cutoff});
  for (const Deformation& d : animation.deformations)
    pose.meshes.push_back({d.mesh, shape_at(d, animation, world, seconds, scene.meshes[d.mesh].indices)});
}

}  // namespace

Pose pose_at(const Scene& scene, double seconds) {
  Pose pose;
  for (const Instance& instance : scene.instances) {
    pose.instances.push_back(instance.world_from_object);
    pose.visible.push_back(instance.visible);
  }
  for (const Camera& camera : scene.cameras) pose.cameras.push_back(camera.world_from_camera);
  for (const Light& light : scene.lights) {
    pose.lights.push_back(light.world_from_light);
    pose.intensities.push_back(light.intensity);
  }
  if (!scene.animation) return pose;
  const Animation& animation = *scene.animation;
  const std::vector<glm::dmat4> world = node_transforms(animation, seconds);
  for (const Attachment& a : animation.instances)
    pose.instances[a.target] = world[a.node] * a.node_from_target;
  for (const Attachment& a : animation.cameras)
    pose.cameras[a.target] = rigid(world[a.node] * a.node_from_target);
  for (const Attachment& a : animation.lights)
    pose.lights[a.target] = rigid(world[a.node] * a.node_from_target);
  change(scene, animation, world, seconds, pose);
  return pose;
}

void apply(const Pose& pose, Scene& scene) {
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    scene.instances[i].world_from_object = pose.instances[i];
    scene.instances[i].visible = pose.visible[i];
  }
  for (size_t i = 0; i < scene.cameras.size(); ++i) scene.cameras[i].world_from_camera = pose.cameras[i];
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    scene.lights[i].world_from_light = pose.lights[i];
    scene.lights[i].intensity = pose.intensities[i];
  }
  for (const PosedMaterial& posed : pose.materials) {
    scene.materials[posed.material].base_color = posed.base_color;
    scene.materials[posed.material].alpha_cutoff = posed.alpha_cutoff;
  }
  for (const PosedMesh& posed : pose.meshes) {
    Mesh& mesh = scene.meshes[posed.mesh];
    mesh.positions = posed.shape.positions;
    mesh.normals = posed.shape.normals;
    mesh.bounds = {};
    for (const glm::vec3& p : mesh.positions) mesh.bounds.add(glm::dvec3(p));
  }
}

Scene posed(const Scene& scene, double seconds) {
  Scene copy = scene;
  apply(pose_at(scene, seconds), copy);
  return copy;
}

glm::dmat4 rigid(const glm::dmat4& transform) {
  const auto direction = [](const glm::dvec3& v, const glm::dvec3& otherwise) {
    const double length = glm::length(v);
    return length > 1e-100 && std::isfinite(length) ? v / length : otherwise;
  };
  const glm::dvec3 z = direction(glm::dvec3(transform[2]), {0, 0, 1});
  const glm::dvec3 spare = std::abs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  glm::dvec3 y = direction(glm::dvec3(transform[1]), spare);
  if (glm::length(glm::cross(y, z)) < 1e-9) y = spare;
  const glm::dvec3 x = glm::normalize(glm::cross(y, z));
  glm::dmat4 result(1.0);
  result[0] = glm::dvec4(x, 0.0);
  result[1] = glm::dvec4(glm::cross(z, x), 0.0);
  result[2] = glm::dvec4(z, 0.0);
  result[3] = glm::dvec4(glm::dvec3(transform[3]), 1.0);
  return result;
}

}  // namespace gnomon
