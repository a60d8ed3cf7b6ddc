// Copies device images to the CPU.
#include "engine/vulkan/readback.h"

#include <fmt/format.h>

#include <cstring>
#include <glm/gtc/packing.hpp>

#include "engine/base/error.h"
#include "engine/base/format.h"
#include "engine/image/srgb.h"

namespace gnomon {
namespace {

uint32_t components(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R16G16_SNORM:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R16G16_SINT:
    case VK_FORMAT_R16G16_UINT:
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R32G32_SFLOAT:
      return 2;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_UNORM:
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return 4;
    default:
      return 1;
  }
}

template <class T>
T load(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

float component(VkFormat format, const std::byte* texel, uint32_t c) {
  switch (format) {
    case VK_FORMAT_R8_UNORM:
    case VK_FORMAT_R8G8B8A8_UNORM:
      return float(load<uint8_t>(texel + c)) / 255.0f;
    case VK_FORMAT_R8G8B8A8_SRGB:  // linear; alpha is as it is
      return c < 3 ? srgb_decode(load<uint8_t>(texel + c)) : float(load<uint8_t>(texel + c)) / 255.0f;
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return glm::unpackHalf1x16(load<uint16_t>(texel + 2 * c));
    case VK_FORMAT_R16G16_SNORM:
      return std::max(-1.0f, float(load<int16_t>(texel + 2 * c)) / 32767.0f);
    case VK_FORMAT_R16G16B16A16_UNORM:
      return float(load<uint16_t>(texel + 2 * c)) / 65535.0f;
    case VK_FORMAT_R16G16_SINT:
      return float(load<int16_t>(texel + 2 * c));
    case VK_FORMAT_R16G16_UINT:
      return float(load<uint16_t>(texel + 2 * c));
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R32G32B32A32_UINT:
      return float(load<uint32_t>(texel + 4 * c));
    default:
      return load<float>(texel + 4 * c);
  }
}

std::vector<std::string> channel_names(uint32_t layers, uint32_t count) {
  static constexpr const char* kNames[] = {"R", "G", "B", "A"};
  std::vector<std::string> names;
  for (uint32_t layer = 0; layer < layers; ++layer)
    for (uint32_t c = 0; c < count; ++c)
      names.push_back((layer ? fmt::format("light{}.", layer) : std::string()) +
                      (count == 1 ? "Y" : kNames[c]));
  return names;
}

// The depth aspect alone is copied: 4 bytes a texel.
uint32_t texel_bytes_copied(VkFormat format) { return is_depth(format) ? 4 : texel_bytes(format); }

// Mip 0 of all layers, tightly packed, in host memory.
Buffer stage(const std::shared_ptr<Device>& device, const GpuImage& image, uint32_t bytes) {
  const ImageShape& shape = image.shape();
  const Extent size = shape.extent;
  Buffer staging(device, uint64_t(size.width) * size.height * shape.layers * bytes,
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT, Place::host);
  OneShot once(device);
  VkBufferImageCopy copy{};
  const VkImageAspectFlags aspect =
      is_depth(shape.format) ? VkImageAspectFlags(VK_IMAGE_ASPECT_DEPTH_BIT) : image.aspect();
  copy.imageSubresource = {aspect, 0, 0, shape.layers};
  copy.imageExtent = {size.width, size.height, 1};
  vkCmdCopyImageToBuffer(once.commands(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                         staging.handle(), 1, &copy);
  VkMemoryBarrier2 to_host{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  to_host.srcStageMask = VK_PIPELINE_STAGE_2_TRANSFER_BIT,
  to_host.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  to_host.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT, to_host.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &to_host;
  vkCmdPipelineBarrier2(once.commands(), &info);
  once.submit_and_wait();
  return staging;
}

}  // namespace

Image read_back(const std::shared_ptr<Device>& device, const GpuImage& image, Extent shown) {
  const ImageShape& shape = image.shape();
  const Extent size = shape.extent;
  const uint32_t bytes = texel_bytes_copied(shape.format);
  const Buffer staging = stage(device, image, bytes);
  const uint32_t count = components(shape.format);
  Image result(shown.width, shown.height, channel_names(shape.layers, count));
  for (uint32_t layer = 0; layer < shape.layers; ++layer)
    for (uint32_t y = 0; y < shown.height; ++y)
      for (uint32_t x = 0; x < shown.width; ++x) {
        const uint64_t texel = (uint64_t(layer) * size.height + std::min(y, size.height - 1)) * size.width +
                               std::min(x, size.width - 1);
        for (uint32_t c = 0; c < count; ++c)
          result.at(x, y, layer * count + c) =
              component(shape.format, staging.bytes().data() + texel * bytes, c);
      }
  return result;
}

std::vector<uint32_t> read_back_words(const std::shared_ptr<Device>& device, const GpuImage& image) {
  const ImageShape& shape = image.shape();
  if (components(shape.format) != 1 || texel_bytes_copied(shape.format) != 4)
    fail(fmt::format("an image of {} has no 32-bit words", format_name(shape.format)));
  const Buffer staging = stage(device, image, 4);
  std::vector<uint32_t> words(size_t(shape.extent.width) * shape.extent.height * shape.layers);
  std::memcpy(words.data(), staging.bytes().data(), words.size() * 4);
  return words;
}

}  // namespace gnomon
