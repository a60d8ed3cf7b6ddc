// The flat receivers of a scene: its largest groups of coplanar triangles.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "engine/scene/scene.h"

namespace gnomon {

struct ReceiverPlane {
  glm::dvec4 plane;  // world: dot(plane.xyz, x) + plane.w = 0, unit normal
  double area = 0;   // of its triangles, world units squared
};

// How far from its plane a triangle's corners may lie to belong to it, as a part of the scene's radius: what
// float positions of the scene's size round to, with room for a few operations.
inline constexpr double kCoplanarPart = 4e-6;

// At most `most`, largest area first. Triangles of all instances that stand still count, whichever way they
// face.
std::vector<ReceiverPlane> receiver_planes(const Scene& scene, size_t most);

}  // namespace gnomon
