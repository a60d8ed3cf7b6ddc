// The JSON of a glTF file and the binary chunk of a .glb, checked. Internal to the scene loader.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "engine/scene/gltf_uri.h"

namespace gnomon {

struct GltfDocument {
  nlohmann::json json;  // an object; what is read of its top level are arrays of objects
  Bytes binary;         // the second chunk; empty when there is none
};

// Buffers and views are inside each other; every other reference is still unchecked. Error: broken container,
// not JSON, nested deeper than 64, not glTF 2.0, shapes and byte ranges that do not hold.
GltfDocument parse_gltf(Bytes bytes, const std::string& file);

}  // namespace gnomon
