// What a pre-filtered shadow map holds: the basis that depth is transformed to,
// shared by the passes that write, filter and read it.
#pragma once

#include "engine/graph/pass.h"
#include "engine/vulkan/pipeline.h"

namespace gnomon {

// How an image of such a map is laid out: `layers` to a view of the light.
struct MomentLayout {
  VkFormat format = VK_FORMAT_UNDEFINED;
  uint32_t layers = 1;
};

// Of the pass that transforms: parameters `basis`, `space`, `precision`, `exponent`, `negative_exponent`,
// `terms`. Exponents that overflow the format are refused.
MomentLayout declare_basis(Declaration& d);
// ... and, once it is declared, what the output that has them says of itself.
void set_basis(Declaration& d, const std::string& output);

// Of the pass that reads the transform: the same as derived values. Depth that nobody transformed is refused.
void read_basis(Declaration& d, const std::string& input);
// `kernel` as a derived value: the width of the filter that was applied (1: none).
void read_kernel(Declaration& d, const std::string& input);

// Of a filter: `space` and `exponent` as derived values. Depth that nobody transformed is refused: its
// average is no depth. True when averages are taken of logarithms.
bool read_space(Declaration& d, const std::string& input);

// GLSL type and swizzle of a texel of such an image, and its layers to a view.
Defines moment_defines(const ImageShape& image, uint32_t views);

}  // namespace gnomon
