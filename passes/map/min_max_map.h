// A min-max map of the input `shadow_map`: what is plainly lit or plainly in umbra over a whole filter window
// needs no filter. Readers use shaders/glsl/lib/min_max.glsl and the transient `around`.
#pragma once

#include "engine/graph/pass.h"
#include "engine/vulkan/pipeline.h"

namespace gnomon {

class MinMaxMap {
 public:
  // Transients `blocks` and `around`: least and greatest depth of blocks of 8x8 texels, and of all blocks
  // that a window reaches from there.
  static void declare(Declaration& d, const ImageShape& shadow_map);
  // `reach`: texels that a window extends from its pixel's place to each side.
  void prepare(Environment& e, uint32_t reach);
  void record(Context& c);

 private:
  Pipeline blocks_, around_;
  int32_t radius_ = 1;  // blocks
};

}  // namespace gnomon
