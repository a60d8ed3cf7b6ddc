// What a triangle of a scene looks like at a point, on the CPU. Internal to the reference.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "engine/scene/scene.h"

namespace gnomon {

// Barycentric weights of a triangle's three vertices.
using Barycentric = glm::vec3;

// Base colour factor x texture (level 0, filtered and wrapped as the texture says) x COLOR_0; linear, with
// alpha.
glm::vec4 base_color(const Scene& scene, const Mesh& mesh, uint32_t triangle, const Barycentric& weights);
// Alpha of the same, without the work for the colour.
float base_alpha(const Scene& scene, const Mesh& mesh, uint32_t triangle, const Barycentric& weights);
// Interpolated vertex normal in world space, unit length; the geometric normal where the vertices cancel out.
glm::vec3 interpolated_normal(const Mesh& mesh, uint32_t triangle, const Barycentric& weights,
                              const glm::dmat3& normal_matrix, const glm::dvec3& geometric);

}  // namespace gnomon
