// GLSL text generated from a pass' declaration: bindings of set 1, parameter block, defines.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/graph/pass.h"
#include "engine/scene/scene.h"
#include "engine/vulkan/shader.h"

namespace gnomon {

// A port that shaders see, in binding order. The parameter block, when there is one, is bound after the last.
struct ShaderPort {
  const Port* port = nullptr;
  uint32_t binding = 0;
};
std::vector<ShaderPort> shader_ports(const Declaration& declaration);

// Mip levels that shaders see of a storage image, each an element of an array with constant indices: all of
// one that the pass both reads and writes, so that it can make one level from another; otherwise the first
// alone.
uint32_t storage_levels(const Port& port);

// Text: one declaration per port, named as the port. Sampled images `x` get `x_at(ivec2)` (arrays:
// `x_at(ivec2, int layer)`), which read the single texel of an input that was folded to a constant; arrays
// with mip levels `x_at(ivec2, int layer, int level)` too. Integer and number parameters are `params.name`. A
// connected buffer `x` has X_COUNT elements; LIGHT_COUNT is the scene's. The pass' constants come first.
std::string preamble(const Declaration& declaration, const std::map<std::string, bool>& constant_inputs);

// NO_DIRECTIONAL_LIGHTS or ALL_DIRECTIONAL_LIGHTS where all lights are of one kind, so that shaders leave out
// the other; empty otherwise.
std::string light_kind_text(const std::vector<Light>& lights);
// ORTHOGRAPHIC_CAMERA where it is one.
std::string camera_kind_text(const Camera& camera);

// Flags: NAME 0 or 1. Choices: NAME = index of the chosen, and NAME_CHOICE for each possible one.
Defines parameter_defines(const Params& params);

// The parameter block's bytes (std140 scalars are 4 bytes each, in declaration order); empty when there is
// none.
std::vector<std::byte> parameter_block(const Params& params);

}  // namespace gnomon
