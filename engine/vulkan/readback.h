// From a device image to an Image.
#pragma once

#include "engine/image/image.h"
#include "engine/vulkan/resources.h"

namespace gnomon {

// Mip 0 of all layers; the image is in TRANSFER_SRC layout. Channels: "Y" ("R","G",... for several
// components), layer n > 0 prefixed "lightn.". A smaller image (a folded constant) is repeated over `shown`.
Image read_back(const std::shared_ptr<Device>& device, const GpuImage& image, Extent shown);
// The texels of a one-component 32-bit image as they are, layer after layer, row 0 at the top. Error for
// other formats.
std::vector<uint32_t> read_back_words(const std::shared_ptr<Device>& device, const GpuImage& image);

}  // namespace gnomon
