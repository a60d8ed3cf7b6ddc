// How a scene moves: the animated part of a glTF file's node tree, and the scene's pose at a time. No device
// and no file.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <vector>

#include "engine/scene/deformation.h"
#include "engine/scene/scene.h"

namespace gnomon {

enum class Interpolation { step, linear, cubic_spline };

// Key frames of one property. Values: x, y, z (translation, scale), a unit quaternion x, y, z, w, a colour,
// or x alone (intensity, cutoff, visibility: not 0).
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

glm::dvec4 values_at(const Track& track, double seconds);

// Key frames of morph weights: `count` a time, of a cubic spline thrice as many.
struct WeightTrack {
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times, values;
  size_t count = 0;
};
std::vector<double> weights_at(const WeightTrack& track, double seconds);

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
  bool moving = false;  // has a track of its transform or visibility, or an ancestor has
  bool visible = true;  // by itself, where no track says
  std::optional<Track> visibility;
  std::optional<WeightTrack> weights;  // of the morph targets of its mesh
};

// An instance, camera or light that hangs on a moving node.
struct Attachment {
  uint32_t target = 0;  // index into the scene's instances, cameras or lights
  size_t node = 0;
  glm::dmat4 node_from_target{1.0};
};

struct ChangingLight {
  uint32_t light = 0;    // index into the scene's
  double intensity = 1;  // where no track says
  std::optional<Track> track;
  std::optional<size_t> node;  // that shows and hides it
};

struct ChangingMaterial {
  uint32_t material = 0;  // index into the scene's
  glm::vec4 base_color{1.0f};
  float alpha_cutoff = 0.5f;
  std::optional<Track> color, cutoff;
};

struct BlinkingInstance {  // shown and hidden where it stands: a skin
  uint32_t instance = 0;
  size_t node = 0;
};

struct Animation {
  std::vector<AnimatedNode> nodes;  // parents before children
  std::vector<Attachment> instances, cameras, lights;
  std::vector<BlinkingInstance> blinking;
  std::vector<ChangingLight> changing_lights;
  std::vector<ChangingMaterial> changing_materials;
  std::vector<Deformation> deformations;  // of meshes that move within
};
// Nothing is attached to it.
bool is_idle(const Animation& animation);

// Scales of moving nodes nearer to 0 than this (of 1) become this, so that every transform keeps its inverse.
constexpr double kSmallestScale = 1e-6;

// world_from_node of every node. Times are clamped to the key frames: nothing repeats.
std::vector<glm::dmat4> node_transforms(const Animation& animation, double seconds);

// Seconds to the last key frame.
double duration(const Animation& animation);

// Which nodes show: each by itself, and all above it.
std::vector<bool> node_visibility(const Animation& animation, double seconds);
// A deformation's shape then. `world_from_node`: node_transforms() of the same time.
Shape shape_at(const Deformation& deformation, const Animation& animation,
               const std::vector<glm::dmat4>& world_from_node, double seconds,
               std::span<const uint32_t> indices);

struct PosedMesh {
  uint32_t mesh = 0;
  Shape shape;
};
struct PosedMaterial {
  uint32_t material = 0;
  glm::vec4 base_color{1.0f};
  float alpha_cutoff = 0.5f;
};

struct Pose {
  std::vector<glm::dmat4> instances, cameras, lights;  // world_from_object, ...: one each of the scene's
  std::vector<bool> visible;                           // one each of the scene's instances
  std::vector<double> intensities;                     // one each of the scene's lights; 0: hidden
  std::vector<PosedMesh> meshes;                       // those that change
  std::vector<PosedMaterial> materials;                // those that change
};
// Where everything is at a time, clamped as above; what does not move is where the scene has it. Cameras and
// lights are rigid.
Pose pose_at(const Scene& scene, double seconds);
// Moves the scene's instances, cameras and lights, and changes its meshes and materials. `pose`: of this
// scene. Scene::bounds stay those of time 0.
void apply(const Pose& pose, Scene& scene);
// A copy of the scene at a time, meshes included: for the reference, which keeps one anyway.
Scene posed(const Scene& scene, double seconds);

// Position and axes of a transform without its scale; a mirrored or flattened one keeps its -z and, where
// possible, y.
glm::dmat4 rigid(const glm::dmat4& transform);

}  // namespace gnomon
