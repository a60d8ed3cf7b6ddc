// The transfer curve of 8-bit colours.
#pragma once

#include <cstdint>

namespace gnomon {

// Linear light of an 8-bit sRGB value, 0..1 (IEC 61966-2-1).
float srgb_decode(uint8_t byte);

}  // namespace gnomon
