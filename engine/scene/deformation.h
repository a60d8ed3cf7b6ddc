// Shapes that change: morph targets and skins of a mesh, evaluated on the CPU. No device and no file.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/scene/scene.h"

namespace gnomon {

struct MorphTarget {  // differences to the mesh's own, as many as vertices; normals may be empty
  std::vector<glm::vec3> positions, normals;
};

struct Joint {
  size_t node = 0;  // index into Animation::nodes
  glm::dmat4 joint_from_mesh{1.0};
};

// A mesh before its morph targets and its skin (glTF 2.0, 3.7.2.2 and 3.7.3).
struct Deformation {
  uint32_t mesh = 0;                          // index into Scene::meshes
  std::vector<glm::vec3> positions, normals;  // at rest; without normals those of the faces are made
  std::vector<MorphTarget> targets;
  std::vector<double> weights;      // of the targets, where no track moves them
  std::optional<size_t> node;       // whose track moves the weights; index into Animation::nodes
  std::vector<Joint> joints;        // empty: no skin
  size_t influences = 0;            // joints of each vertex
  std::vector<uint16_t> joint_of;   // `influences` of each vertex: index into joints
  std::vector<float> weight_of;     // as many; sum 1
  glm::dmat4 mesh_from_world{1.0};  // of skins: to where the mesh's instance stands
};

struct Shape {  // as many as the mesh's vertices; normals of unit length
  std::vector<glm::vec3> positions, normals;
};

// `weights`: one a target. `world_from_joint`: one a joint. `indices`: the mesh's triangles, for normals of
// faces.
Shape shape_of(const Deformation& deformation, std::span<const double> weights,
               std::span<const glm::dmat4> world_from_joint, std::span<const uint32_t> indices);

}  // namespace gnomon
