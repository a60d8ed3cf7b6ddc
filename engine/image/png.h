// PNG through stb_image and stb_image_write; used by image.cpp only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "engine/image/image.h"

namespace gnomon::png {

// 8- or 16-bit PNG as 0..1, channels Y, YA, RGB or RGBA as in the file. Error when it cannot be decoded.
Image read(const std::filesystem::path& file);
// Interleaved 8-bit pixels to the bytes of a PNG file. Error (naming `file`) when out of memory.
std::string encode(std::span<const uint8_t> pixels, uint32_t width, uint32_t height, uint32_t channels,
                   const std::filesystem::path& file);

}  // namespace gnomon::png
