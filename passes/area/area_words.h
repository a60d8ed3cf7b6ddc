// What adaptive sampling keeps of its samples, from area_refine to area_resolve;
// shaders/glsl/area/area_words.glsl. A slot holds a sample: a bit in each pixel's words, a plane of bits, a
// layer of values, a weight.
#pragma once

#include "engine/graph/pass.h"

namespace gnomon {

constexpr uint32_t kWordSamples = 32;

// Outputs `lit_words`, `edge_words`, `values`, `weights`, `sample_ranges`; transients `lit_planes`,
// `edge_planes`. For `wanted` slots, or as many as three quarters of the memory limit hold: returned.
uint32_t declare_sample_outputs(Declaration& d, Extent pixels, uint32_t wanted);
// The same as inputs, without the planes. Returns the pixels.
Extent declare_sample_inputs(Declaration& d);

}  // namespace gnomon
