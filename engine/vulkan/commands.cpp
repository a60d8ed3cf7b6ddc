// Small commands that several parts of the engine record: barriers, clears, mip levels.
#include "engine/vulkan/commands.h"

#include <algorithm>

#include "engine/base/format.h"

namespace gnomon {

void full_barrier(VkCommandBuffer commands) {
  VkMemoryBarrier2 all{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  all.srcStageMask = all.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  all.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  all.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &all;
  vkCmdPipelineBarrier2(commands, &info);
}

namespace {

void change_layout(VkCommandBuffer commands, const GpuImage& image, uint32_t first_mip, uint32_t mips,
                   VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier2 b{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  b.srcStageMask = b.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  b.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  b.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  b.oldLayout = from, b.newLayout = to;
  b.srcQueueFamilyIndex = b.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  b.image = image.handle();
  b.subresourceRange = {image.aspect(), first_mip, mips, 0, VK_REMAINING_ARRAY_LAYERS};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &b;
  vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace

void change_layout(VkCommandBuffer commands, const GpuImage& image, VkImageLayout from, VkImageLayout to) {
  change_layout(commands, image, 0, VK_REMAINING_MIP_LEVELS, from, to);
}

void clear_image(VkCommandBuffer commands, const GpuImage& image, const std::array<float, 4>& value,
                 VkImageLayout then) {
  constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  const VkImageSubresourceRange all{image.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
  const VkClearColorValue color{{value[0], value[1], value[2], value[3]}};
  const VkClearDepthStencilValue depth{value[0], 0};
  change_layout(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, kLayout);
  if (is_depth(image.shape().format))
    vkCmdClearDepthStencilImage(commands, image.handle(), kLayout, &depth, 1, &all);
  else
    vkCmdClearColorImage(commands, image.handle(), kLayout, &color, 1, &all);
  if (then != VK_IMAGE_LAYOUT_UNDEFINED) change_layout(commands, image, kLayout, then);
}

void generate_mips(VkCommandBuffer commands, const GpuImage& image) {
  constexpr VkImageLayout kFrom = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                          kTo = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  const ImageShape& shape = image.shape();
  const auto corner = [&](uint32_t mip) {
    return VkOffset3D{int32_t(std::max(1u, shape.extent.width >> mip)),
                      int32_t(std::max(1u, shape.extent.height >> mip)), 1};
  };
  change_layout(commands, image, 0, 1, VK_IMAGE_LAYOUT_GENERAL, kFrom);
  for (uint32_t mip = 1; mip < shape.mips; ++mip) {
    change_layout(commands, image, mip, 1, VK_IMAGE_LAYOUT_UNDEFINED, kTo);
    VkImageBlit halve{};
    halve.srcSubresource = {image.aspect(), mip - 1, 0, shape.layers};
    halve.dstSubresource = {image.aspect(), mip, 0, shape.layers};
    halve.srcOffsets[1] = corner(mip - 1), halve.dstOffsets[1] = corner(mip);
    vkCmdBlitImage(commands, image.handle(), kFrom, image.handle(), kTo, 1, &halve, VK_FILTER_LINEAR);
    change_layout(commands, image, mip, 1, kTo, kFrom);
  }
  change_layout(commands, image, kFrom, VK_IMAGE_LAYOUT_GENERAL);
}

}  // namespace gnomon
