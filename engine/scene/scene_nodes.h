// The node tree of a glTF file in double precision, and what hangs on it. Internal to the scene loader.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "engine/scene/animation.h"
#include "engine/scene/gltf_file.h"
#include "engine/scene/scene.h"

namespace gnomon {

struct PlacedNode {
  size_t node = 0;               // in the file
  std::optional<size_t> parent;  // index of an earlier placed node; absent: a root
  NodeTransform local;
  glm::dmat4 world_from_node{1.0};
  bool moving = false;       // some animation moves it; world_from_node is that of time 0
  bool shows_itself = true;  // KHR_node_visibility
  bool visible = true;       // it and all nodes above show themselves at time 0
  bool ever_visible = true;  // at some time of the animations
  bool blinks = false;       // some animation shows and hides it
};

// Nodes of the default scene (the first scene, or all roots, when none is named), parents before children.
// Error for references out of range, nodes reached twice (cycles too) and transforms that are not finite.
std::vector<PlacedNode> walk_nodes(const GltfFile& gltf, SceneWarnings& warnings);

// Extras of the scene that walk_nodes() takes; null when it has none.
const tinygltf::Value& scene_extras(const GltfFile& gltf);

// Rigid: at `eye`, looking along -z at `target`.
glm::dmat4 looking_at(const glm::dvec3& eye, const glm::dvec3& target);

// Those that move are attached to `animation` (Attachment::node: index into `nodes`), which may be null.
void read_cameras(const GltfFile& gltf, const std::vector<PlacedNode>& nodes, Scene& scene,
                  Animation* animation);
// `intensities`: tracks of the file's lights, by their index.
void read_lights(const GltfFile& gltf, const std::vector<PlacedNode>& nodes, Scene& scene,
                 Animation* animation, const std::map<size_t, Track>& intensities);
// Default ones when there are none, with a warning each. Scene::bounds must be known.
void ensure_camera(Scene& scene);
void ensure_light(Scene& scene);
// Warns for every spot and point light inside a watertight mesh (odd number of crossings of a ray).
void warn_enclosed_lights(Scene& scene);

}  // namespace gnomon
