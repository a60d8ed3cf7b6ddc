// Small commands that several parts of the engine record.
#pragma once

#include <array>

#include "engine/vulkan/resources.h"

namespace gnomon {

// Everything recorded so far is done and visible before anything later starts.
void full_barrier(VkCommandBuffer commands);

// All of the image, after everything recorded so far.
void change_layout(VkCommandBuffer commands, const GpuImage& image, VkImageLayout from, VkImageLayout to);

// One value in every texel; the image's old contents are lost. `then`: layout to leave it in (undefined:
// transfer).
void clear_image(VkCommandBuffer commands, const GpuImage& image, const std::array<float, 4>& value,
                 VkImageLayout then);

// Levels 1 and up of all layers, each the level before it at half the size (Environment::check_mips). The
// image is in the general layout before and after, and its usage includes both transfers.
void generate_mips(VkCommandBuffer commands, const GpuImage& image);

}  // namespace gnomon
