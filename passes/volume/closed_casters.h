// Which casters may cast from their far side alone: nothing that the camera sees is inside of them.
#pragma once

#include <vector>

#include "engine/scene/scene.h"

namespace gnomon {

// Is the mesh watertight, and its outside its front? Every shell of it (triangles that hang together) faces
// outwards, or is a hollow: it faces inwards, inside of the others.
bool is_solid(const Mesh& mesh);
// The same of every mesh, asked of single-sided ones alone.
std::vector<bool> solid_meshes(const Scene& scene);

// Instances of solid meshes, single-sided, that the camera's near plane does not touch and is not in: of what
// is inside of them nothing is seen. `solid`: solid_meshes().
std::vector<bool> unseen_inside(const Scene& scene, const std::vector<bool>& solid, const Camera& camera,
                                double aspect);

}  // namespace gnomon
