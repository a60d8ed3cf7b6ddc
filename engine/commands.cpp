#include "engine/commands.h"

#include "engine/compile.h"

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

void change_layout(VkCommandBuffer commands, const GpuImage& image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier2 b{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  b.srcStageMask = b.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  b.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  b.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  b.oldLayout = from, b.newLayout = to;
  b.srcQueueFamilyIndex = b.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  b.image = image.handle();
  b.subresourceRange = {image.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &b;
  vkCmdPipelineBarrier2(commands, &info);
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

}  // namespace gnomon
