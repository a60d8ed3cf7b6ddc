// A scene as Gnomon understood it, written as glTF.
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace gnomon {

// The bytes of a .glb file: instances as nodes, meshes with one primitive each, materials with their masks,
// textures as PNG, cameras, lights with their area. Of an animated scene the pose that it is in.
std::string to_glb(const Scene& scene);

}  // namespace gnomon
