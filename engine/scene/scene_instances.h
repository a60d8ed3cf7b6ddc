// What the nodes of a glTF file place: instances of meshes. Internal to the scene loader.
#pragma once

#include <vector>

#include "engine/scene/animation.h"
#include "engine/scene/gltf_file.h"
#include "engine/scene/scene.h"
#include "engine/scene/scene_nodes.h"

namespace gnomon {

// Reads each primitive once and shares it between its instances. Those that move are attached to `animation`
// (Attachment::node: index into `nodes`), which may be null. Hidden nodes place nothing. Error for references
// out of range, and for more instances than 2^20.
void read_instances(const GltfFile& gltf, const std::vector<PlacedNode>& nodes, Scene& scene,
                    Animation* animation);

}  // namespace gnomon
