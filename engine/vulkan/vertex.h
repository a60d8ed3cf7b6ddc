// The layout of vertices in buffers.
#pragma once

#include <cstdint>

namespace gnomon {

struct VertexAttributes {  // 20 bytes; positions are in a buffer of their own
  int16_t normal[2];       // octahedral, snorm
  float uv[2];
  uint16_t color[4];  // linear, unorm
};

}  // namespace gnomon
