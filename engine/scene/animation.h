// How a scene moves: the animated part of a glTF file's node tree, and the scene's pose at a time. No device
// and no file.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <vector>

#include "engine/scene/scene.h"

namespace gnomon {

enum class Interpolation { step, linear, cubic_spline };

// Key frames of one property of a node. Values: x, y, z (translation, scale) or a unit quaternion x, y, z, w.
struct Track {
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;  // seconds from 0, strictly increasing, at least one
  // One a time; of a cubic spline three: in-tangent, value, out-tangent (per second).
  std::vector<glm::dvec4> values;
};

// The track's value (glTF 2.0, appendix C); before the first key frame that one's, after the last that one's.
glm::dvec3 vector_at(const Track& track, double seconds);
// Linear: spherical, the shorter way round. Cubic: normalised. A unit quaternion.
glm::dquat rotation_at(const Track& track, double seconds);

// A node's transform to its parent: a matrix, or translation * rotation * scale.
struct NodeTransform {
  std::optional<glm::dmat4> matrix;
  glm::dvec3 translation{0.0}, scale{1.0};
  glm::dquat rotation{1, 0, 0, 0};
  glm::dmat4 parent_from_node() const;
};

struct AnimatedNode {
  std::optional<size_t> parent;  // index of an earlier node; absent: a root
  NodeTransform rest;            // of what has no track
  std::optional<Track> translation, rotation, scale;
  bool moving = false;  // has a track, or an ancestor has
};

// An instance, camera or light that hangs on a moving node.
struct Attachment {
  uint32_t target = 0;  // index into the scene's instances, cameras or lights
  size_t node = 0;
  glm::dmat4 node_from_target{1.0};
};

struct Animation {
  std::vector<AnimatedNode> nodes;  // parents before children
  std::vector<Attachment> instances, cameras, lights;
};

// Scales of moving nodes nearer to 0 than this (of 1) become this, so that every transform keeps its inverse.
constexpr double smallest_scale = 1e-6;

// world_from_node of every node. Times are clamped to the key frames: nothing repeats.
std::vector<glm::dmat4> node_transforms(const Animation& animation, double seconds);

// Seconds to the last key frame.
double duration(const Animation& animation);

struct Pose {  // world_from_object, world_from_camera, world_from_light: one each of the scene's
  std::vector<glm::dmat4> instances, cameras, lights;
};
// Where everything is at a time, clamped as above; what does not move is where the scene has it. Cameras and
// lights are rigid.
Pose pose_at(const Scene& scene, double seconds);
// Moves the scene's instances, cameras and lights. `pose`: of this scene. Scene::bounds stay those of time 0.
void apply(const Pose& pose, Scene& scene);
// A copy of the scene at a time, meshes included: for the reference, which keeps one anyway.
Scene posed(const Scene& scene, double seconds);

// Position and axes of a transform without its scale; a mirrored or flattened one keeps its -z and, where
// possible, y.
glm::dmat4 rigid(const glm::dmat4& transform);

}  // namespace gnomon
