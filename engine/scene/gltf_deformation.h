// Morph targets and skins of a glTF file. Internal to the scene loader.
#pragma once

#include <optional>

#include "engine/scene/deformation.h"
#include "engine/scene/gltf_file.h"
#include "engine/scene/scene_nodes.h"

namespace gnomon {

// What changes the shape of a primitive where a node places it: Deformation::mesh, positions and normals are
// those of `mesh`, as it is read from the file; joints' nodes and `node` are indices into `nodes`, whose
// `node`-th places it. Nothing when it has neither targets nor a skin. Error for references, counts and
// values that do not hold; a skin whose joints are not in the scene is left out with a warning.
std::optional<Deformation> read_deformation(const GltfFile& gltf, const std::vector<PlacedNode>& nodes,
                                            size_t node, size_t primitive, const Mesh& mesh,
                                            SceneWarnings& warnings);

}  // namespace gnomon
