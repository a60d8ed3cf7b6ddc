// Values of a glTF accessor, with every byte range checked first. Internal to the scene loader.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "engine/scene/gltf_file.h"

namespace gnomon {

// Elements of a vector accessor as floats, sparse ones included; missing components are filled from `fill`.
// Normalised integers become [0, 1] or [-1, 1] (glTF 2.0, 3.6.2.2). Error at `place` for a reference, type or
// byte range that does not hold. `components`: accepted numbers of components, e.g. {3, 4}.
std::vector<glm::vec4> read_vectors(const GltfFile& gltf, int accessor, const std::string& place,
                                    const std::vector<int>& components,
                                    const glm::vec4& fill = glm::vec4(0.0f));

// 4 x 4 matrices of floats, column-major, all finite.
std::vector<glm::dmat4> read_matrices(const GltfFile& gltf, int accessor, const std::string& place);

// An index accessor (unsigned byte, short or int scalars); every value must be < `vertices`.
std::vector<uint32_t> read_indices(const GltfFile& gltf, int accessor, const std::string& place,
                                   size_t vertices);

}  // namespace gnomon
