// A glTF file's container and document, checked before anything in it is used. Internal to the scene loader.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace gnomon {

// The parsed document. Buffers are loaded; images hold their encoded bytes in Image::image (as_is),
// decode_image() decodes one. Byte ranges of buffer views are inside their buffers; every other reference is
// still unchecked.
struct GltfFile {
  std::string file;  // for messages
  tinygltf::Model model;
};

// .glb (by its magic number) or .gltf. Throws Error: missing file, not glTF, broken container, buffers or
// views, required extensions that change the geometry's encoding.
GltfFile read_gltf(const std::filesystem::path& file, SceneWarnings& warnings);

// RGBA, 8 bits per channel, row 0 at the top; false when it cannot be decoded or is larger than 16384 texels
// a side.
bool decode_image(const tinygltf::Image& encoded, uint32_t& width, uint32_t& height,
                  std::vector<uint8_t>& rgba);

// "/meshes/2": a JSON pointer's next step.
std::string at(const std::string& pointer, const std::string& member);
std::string at(const std::string& pointer, size_t index);

}  // namespace gnomon
