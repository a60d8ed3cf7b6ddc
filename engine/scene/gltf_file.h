// A glTF file's container and document, checked before anything in it is used. Internal to the scene loader.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace gnomon {

// The parsed document. Buffers are loaded and compressed views unpacked; of an image there are only the name,
// URI, buffer view and media type. Byte ranges of buffer views are inside their buffers; every other
// reference is still unchecked.
struct GltfFile {
  std::string file;              // for messages
  std::filesystem::path folder;  // that URIs are relative to
  tinygltf::Model model;
};

// .glb (by its magic number) or .gltf. Throws Error: missing file, not glTF, broken container, buffers or
// views, required extensions that are not known.
GltfFile read_gltf(const std::filesystem::path& file, SceneWarnings& warnings);

// "/meshes/2": a JSON pointer's next step.
std::string at(const std::string& pointer, const std::string& member);
std::string at(const std::string& pointer, size_t index);

}  // namespace gnomon
