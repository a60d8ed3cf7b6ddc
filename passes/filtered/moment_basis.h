// What a pre-filtered shadow map holds: the basis that depth is transformed to,
// shared by the passes that write, filter and read it.
#pragma once

#include "engine/graph/pass.h"
#include "engine/vulkan/pipeline.h"

namespace gnomon {

// How an image of such a map is laid out: `layers` to a face of the light.
struct MomentLayout {
  VkFormat format = VK_FORMAT_UNDEFINED;
  uint32_t layers = 1;
};

// Parameters `basis`, `space`, `precision`, `exponent`, `negative_exponent`,
// `terms`; both the pass that transforms and the one that reads must have the
// same values. Exponents that overflow the format are refused.
MomentLayout declare_basis(Declaration& d);

// Parameters `space` and `exponent` alone, as the filter needs them.
std::string declare_space(Declaration& d);
double declare_exponent(Declaration& d, double standard);

// GLSL type and swizzle of a texel of such an image, and its layers to a face.
Defines moment_defines(const ImageShape& image, uint32_t faces);

}  // namespace gnomon
