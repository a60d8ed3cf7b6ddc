// Small commands that several parts of the engine record.
#pragma once

#include <array>

#include "engine/resources.h"

namespace gnomon {

// Everything recorded so far is done and visible before anything later starts.
void full_barrier(VkCommandBuffer commands);

// All of the image, after everything recorded so far.
void change_layout(VkCommandBuffer commands, const GpuImage& image, VkImageLayout from, VkImageLayout to);

// One value in every texel; the image's old contents are lost. `then`: layout to leave it in (undefined:
// transfer).
void clear_image(VkCommandBuffer commands, const GpuImage& image, const std::array<float, 4>& value,
                 VkImageLayout then);

}  // namespace gnomon
