// Area lights of the draft glTF extension EXT_lights_area. Internal to the scene loader.
#pragma once

#include <optional>

#include "engine/scene/gltf_file.h"
#include "engine/scene/scene.h"
#include "engine/scene/scene_nodes.h"

namespace gnomon {

// The light that a node's EXT_lights_area names, a rectangle or disk: a spot light of 90 degrees with that
// area, whose intensity is that of its luminance straight ahead. Its size is scaled by the largest of the
// node's world scales, as the draft says. Nothing when the node has none, or, with a warning, when it cannot
// be used. Error when it names a light that is not there.
std::optional<Light> read_lights_area(const GltfFile& gltf, const PlacedNode& placed,
                                      SceneWarnings& warnings);

}  // namespace gnomon
