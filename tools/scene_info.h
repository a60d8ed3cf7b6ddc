// What `gnomon scene info` prints.
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace gnomon {

// Several lines of text: meshes, triangles, materials, lights, cameras, bounds, warnings.
std::string describe_scene(const Scene& scene);

}  // namespace gnomon
