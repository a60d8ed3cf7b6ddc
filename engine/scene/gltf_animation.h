// Animations of a glTF file. Internal to the scene loader.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "engine/scene/animation.h"
#include "engine/scene/gltf_file.h"
#include "engine/scene/scene_nodes.h"

namespace gnomon {

struct GltfAnimation {
  std::shared_ptr<Animation> animation;  // null: nothing changes
  std::map<size_t, Track> intensities;   // of the file's lights
};

// Tracks of all the file's animations together; node i of the result is nodes[i], and changing_materials have
// no values at rest yet. Moves `nodes` to time 0 and marks those that move. Tracks that never change a value
// become the node's transform. Error for accessors and key frames that cannot be read; warns for what is left
// out (nodes with a matrix, properties that are not read, a second track of one property).
GltfAnimation read_animation(const GltfFile& gltf, std::vector<PlacedNode>& nodes, SceneWarnings& warnings);

}  // namespace gnomon
