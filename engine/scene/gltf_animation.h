// Animations of a glTF file. Internal to the scene loader.
#pragma once

#include <memory>
#include <vector>

#include "engine/scene/animation.h"
#include "engine/scene/gltf_file.h"
#include "engine/scene/scene_nodes.h"

namespace gnomon {

// Tracks of all the file's animations together; node i of the result is nodes[i]. Moves `nodes` to time 0 and
// marks those that move. Null when none does: tracks that never change a value become the node's transform.
// Error for accessors and key frames that cannot be read; warns for what is left out (morph targets, nodes
// with a matrix, unknown paths, a second track of one property).
std::shared_ptr<Animation> read_animation(const GltfFile& gltf, std::vector<PlacedNode>& nodes,
                                          SceneWarnings& warnings);

}  // namespace gnomon
