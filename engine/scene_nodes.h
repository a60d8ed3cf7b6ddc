// The node tree of a glTF file in double precision, and what hangs on it. Internal to the scene loader.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "engine/gltf_file.h"
#include "engine/scene.h"

namespace gnomon {

struct PlacedNode {
  size_t node = 0;
  glm::dmat4 world_from_node{1.0};
};

// Nodes of the default scene (the first scene, or all roots, when none is named), parents before children.
// Error for references out of range, nodes reached twice (cycles too) and transforms that are not finite.
std::vector<PlacedNode> walk_nodes(const GltfFile& gltf, SceneWarnings& warnings);

// Extras of the scene that walk_nodes() takes; null when it has none.
const tinygltf::Value& scene_extras(const GltfFile& gltf);

// Position and axes of a transform without its scale; a mirrored or flattened one keeps its -z and, where
// possible, y.
glm::dmat4 rigid(const glm::dmat4& transform);
// Rigid: at `eye`, looking along -z at `target`.
glm::dmat4 looking_at(const glm::dvec3& eye, const glm::dvec3& target);

void read_cameras(const GltfFile& gltf, const std::vector<PlacedNode>& nodes, Scene& scene);
void read_lights(const GltfFile& gltf, const std::vector<PlacedNode>& nodes, Scene& scene);
// Default ones when there are none, with a warning each. Scene::bounds must be known.
void ensure_camera(Scene& scene);
void ensure_light(Scene& scene);
// Warns for every spot and point light inside a watertight mesh (odd number of crossings of a ray).
void warn_enclosed_lights(Scene& scene);

}  // namespace gnomon
