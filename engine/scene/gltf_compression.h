// Compressed geometry of glTF files, unpacked into ordinary buffers before anything else reads them. Internal
// to the scene loader.
#pragma once

#include "engine/scene/gltf_file.h"

namespace gnomon {

// EXT_meshopt_compression and KHR_meshopt_compression: each compressed buffer view becomes one of a buffer of
// its own. Error, by the extension's name, for a broken stream; with an uncompressed fallback a warning.
void unpack_meshopt(GltfFile& gltf, SceneWarnings& warnings);

// KHR_draco_mesh_compression: the attributes and indices of each compressed primitive become accessors of its
// own. Error and fallback as above.
void unpack_draco(GltfFile& gltf, SceneWarnings& warnings);

// A buffer of its own for `bytes`, and a view of it; the view's index.
int add_view(tinygltf::Model& model, std::vector<unsigned char> bytes);

}  // namespace gnomon
