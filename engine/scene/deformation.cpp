// Evaluates morph targets and skins, in double precision.
#include "engine/scene/deformation.h"

#include <cmath>

namespace gnomon {
namespace {

glm::vec3 unit(const glm::dvec3& v, const glm::vec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : otherwise;
}

void morph(const Deformation& deformation, std::span<const double> weights, Shape& shape) {
  for (size_t t = 0; t < deformation.targets.size() && t < weights.size(); ++t) {
    const MorphTarget& target = deformation.targets[t];
    const double weight = weights[t];
    if (weight == 0) continue;
    for (size_t i = 0; i < target.positions.size(); ++i)
      shape.positions[i] =
          glm::vec3(glm::dvec3(shape.positions[i]) + weight * glm::dvec3(target.positions[i]));
    for (size_t i = 0; i < target.normals.size() && i < shape.normals.size(); ++i)
      shape.normals[i] = glm::vec3(glm::dvec3(shape.normals[i]) + weight * glm::dvec3(target.normals[i]));
  }
}

void skin(const Deformation& deformation, std::span<const glm::dmat4> world_from_joint, Shape& shape) {
  std::vector<glm::dmat4> matrices;
  for (size_t j = 0; j < deformation.joints.size(); ++j)
    matrices.push_back(deformation.mesh_from_world * world_from_joint[j] *
                       deformation.joints[j].joint_from_mesh);
  for (size_t i = 0; i < shape.positions.size(); ++i) {
    glm::dmat4 blended(0.0);
    for (size_t k = i * deformation.influences; k < (i + 1) * deformation.influences; ++k)
      if (deformation.weight_of[k] != 0)
        blended += double(deformation.weight_of[k]) * matrices[deformation.joint_of[k]];
    shape.positions[i] = glm::vec3(blended * glm::dvec4(glm::dvec3(shape.positions[i]), 1.0));
    if (i >= shape.normals.size()) continue;
    // The cofactor matrix turns normals rightly for every scale.
    const glm::dmat3 m(blended);
    const glm::dmat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    shape.normals[i] = glm::vec3(cofactor * glm::dvec3(shape.normals[i]));
  }
}

void face_normals(std::span<const uint32_t> indices, Shape& shape) {
  shape.normals.assign(shape.positions.size(), glm::vec3(0, 1, 0));
  for (size_t i = 0; i + 2 < indices.size(); i += 3) {
    const glm::dvec3 a = shape.positions[indices[i]], b = shape.positions[indices[i + 1]],
                     c = shape.positions[indices[i + 2]];
    const glm::vec3 normal = unit(glm::cross(b - a, c - a), {0, 1, 0});
    for (size_t k = 0; k < 3; ++k) shape.normals[indices[i + k]] = normal;
  }
}

}  // namespace

Shape shape_of(const Deformation& deformation, std::span<const double> weights,
               std::span<const glm::dmat4> world_from_joint, std::span<const uint32_t> indices) {
  Shape shape{deformation.positions, deformation.normals};
  morph(deformation, weights, shape);
  if (!deformation.joints.empty()) skin(deformation, world_from_joint, shape);
  if (shape.normals.empty())
    face_normals(indices, shape);
  else
    for (glm::vec3& n : shape.normals) n = unit(glm::dvec3(n), {0, 1, 0});
  return shape;
}

}  // namespace gnomon
