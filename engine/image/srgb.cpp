// The transfer curve of 8-bit colours.
#include "engine/image/srgb.h"

#include <array>
#include <cmath>

namespace gnomon {

float srgb_decode(uint8_t byte) {
  static const auto table = [] {
    std::array<float, 256> values{};
    for (int i = 0; i < 256; ++i) {
      const double c = i / 255.0;
      values[i] = float(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    return values;
  }();
  return table[byte];
}

}  // namespace gnomon
