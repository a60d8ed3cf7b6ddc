// Images of a glTF file, fetched and decoded when something needs them. Internal to the scene loader.
#pragma once

#include <string>

#include "engine/scene/gltf_file.h"
#include "engine/scene/scene.h"

namespace gnomon {

// Fills a texture's size and texels: RGBA, 8 bits per channel, row 0 at the top. Otherwise says why not;
// larger than 16384 texels a side is too large. `index` must be in range.
std::string decode_image(const GltfFile& gltf, size_t index, Texture& texture);

}  // namespace gnomon
