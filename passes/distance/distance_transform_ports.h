// What the pass distance_transform is given and makes, and the units in which it works;
// distance_transform.cpp records it.
#pragma once

#include <cstdint>

#include "engine/graph/pass.h"

namespace gnomon::distance_transform {

constexpr uint32_t kWord = 32;         // pixels of a column in a word; shaders: WORD
constexpr uint32_t kChunk = 32;        // columns of a word of `kept`; shaders: CHUNK
constexpr uint32_t kTile = 16;         // side in pixels; shaders: TILE
constexpr uint32_t kMostLayers = 256;  // that a packed tile tells apart
constexpr uint32_t kMostSide = 16384;  // pixels: squared distances fit 32 bits

// Parameters and ports, of which some depend on the algorithm and on which inputs are connected.
void declare_ports(Declaration& d);

// The units above, for shaders that read `nearest` or `tiles`.
void declare_units(Declaration& d);

// Words of rows that banded_exact handles at once.
uint32_t stripe_words(Extent size);

}  // namespace gnomon::distance_transform
