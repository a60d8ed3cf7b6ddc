// Buffers and images in which adaptive sampling keeps its samples.
#include "passes/area/area_words.h"

#include <algorithm>

#include "engine/base/divide_up.h"
#include "engine/graph/pass.h"

namespace gnomon {
namespace {

constexpr Access kBoth = Access::storage_read | Access::storage_write;
constexpr Access kFromHost = Access::storage_write | Access::host_read;

// Images of more layers are not to be had on every device (Vulkan's limit for desktop devices).
constexpr uint64_t kMostLayers = 2048;

uint32_t slots_for(const Declaration& d, Extent pixels, uint32_t wanted) {
  const uint64_t count = uint64_t(pixels.width) * pixels.height;
  const uint64_t bytes = count + 4 * (count / 8 + pixels.height * 4);  // values; words and planes of two bits
  const uint64_t fitting = d.setting().memory / 4 * 3 / bytes;
  const uint64_t slots = std::min({uint64_t(wanted), fitting, kMostLayers}) / kWordSamples * kWordSamples;
  return uint32_t(std::max<uint64_t>(slots, kWordSamples));
}

}  // namespace

uint32_t declare_sample_outputs(Declaration& d, Extent pixels, uint32_t wanted) {
  const uint32_t slots = slots_for(d, pixels, wanted);
  const uint64_t count = uint64_t(pixels.width) * pixels.height, words = slots / kWordSamples;
  const uint64_t planes = uint64_t(divide_up(pixels.width, kWordSamples)) * pixels.height * slots;
  d.output_buffer("lit_words", kBoth, {count * words, 4, "uint"}, "a bit a sample: is the pixel lit from it");
  d.output_buffer("edge_words", kBoth, {count * words, 4, "uint"},
                  "a bit a sample: is the pixel on its silhouette (algorithm 6's discontinuity maps)");
  d.output("values", Access::storage_write, true, {pixels, slots, 1, VK_FORMAT_R8_UNORM},
           "a layer a sample: visibility of the pixels on its silhouette, undefined elsewhere");
  d.keep("values");  // written iteration by iteration
  d.output_buffer("weights", kFromHost, {slots, 4, "float"}, "of each sample, in (6.4)");
  d.output_buffer("sample_ranges", kFromHost, {uint64_t(2) * d.setting().lights, 4, "uint"},
                  "of each light, its first slot and the number of its samples");
  d.transient_buffer("lit_planes", kBoth, {planes, 4, "uint"}, "lit_words by samples: a bit a pixel");
  d.transient_buffer("edge_planes", kBoth, {planes, 4, "uint"}, "edge_words by samples: a bit a pixel");
  return slots;
}

Extent declare_sample_inputs(Declaration& d) {
  d.input_buffer("lit_words", Access::storage_read, "a bit a sample: is the pixel lit from it");
  d.input_buffer("edge_words", Access::storage_read, "a bit a sample: is the pixel on its silhouette");
  const ImageShape values =
      d.input("values", Access::storage_read, true, "visibility of the pixels on silhouettes");
  d.input_buffer("weights", Access::storage_read, "of each sample");
  d.input_buffer("sample_ranges", Access::storage_read,
                 "of each light, its first slot and the number of its samples");
  return values.extent;
}

}  // namespace gnomon
