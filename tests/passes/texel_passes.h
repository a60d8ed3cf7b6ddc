// Passes for tests of passes that work on maps: one that makes a map of given texels, and one that shows a
// single level, layer and channel of one.
//   "test_texels"  output `texels`: an array of the viewport's size; parameters `layers`, `channels` (1, 2 or
//   4) "test_pick"    input `source`; output `picked`: 32-bit words of the viewport's size, zero beyond the
//   level; parameters
//                  `layer`, `level`, `channel`
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/shape.h"

namespace gnomon::test {

// Of "test_texels": channels of a texel follow each other, then row by row, layer by layer.
std::vector<float>& given_texels();

// Runs "test_texels", then the passes that `nodes` (graph JSON, beginning with a comma) adds, and returns the
// picked words of `port` for each of `picks`.
struct Pick {
  int layer = 0, level = 0, channel = 0;
};
std::vector<std::vector<uint32_t>> picked(Extent size, int layers, int channels, const std::string& nodes,
                                          const std::string& port, const std::vector<Pick>& picks);

}  // namespace gnomon::test
