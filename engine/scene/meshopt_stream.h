// Streams of KHR_meshopt_compression that meshoptimizer before 0.23 does not know: version 1 of attributes,
// and the colour filter (the extension's appendices A and B). Internal to the scene loader.
#pragma once

#include <cstddef>
#include <span>

namespace gnomon {

// `out`: count elements of `stride` bytes, a multiple of 4 up to 256. False: not such a stream, cut off, or
// with bytes left over.
bool decode_attributes_v1(std::span<unsigned char> out, size_t count, size_t stride,
                          std::span<const unsigned char> in);

// YCoCg to RGBA in place; elements of four bytes or four little-endian words.
void decode_color_filter(std::span<unsigned char> elements, size_t stride);

}  // namespace gnomon
