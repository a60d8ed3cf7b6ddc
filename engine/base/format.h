// What the engine knows about image formats.
#pragma once

#include "engine/base/shape.h"

namespace gnomon {

uint32_t texel_bytes(VkFormat format);     // 16 for formats outside the table
std::string format_name(VkFormat format);  // "R8_UNORM"; "format 123" outside the table
bool is_depth(VkFormat format);            // depth, stencil or both
// Bytes of all mips and layers, or of all elements; the largest uint64_t when that overflows.
uint64_t bytes_of(const ImageShape& image);
uint64_t bytes_of(const BufferShape& buffer);

}  // namespace gnomon
