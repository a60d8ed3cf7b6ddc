// How a pass uses a resource: stages, access and layout.
#include "engine/plan/compile.h"
#include "engine/plan/compile_parts.h"

namespace gnomon {
namespace {

VkPipelineStageFlags2 shader_stages(PassKind kind) {
  constexpr VkPipelineStageFlags2 raster =
      VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  switch (kind) {
    case PassKind::compute:
      return VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    case PassKind::raster:
      return raster;
    case PassKind::mixed:
      return raster | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  }
  return VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
}

// The one layout that suits all the ways in which a pass touches an image.
VkImageLayout layout_of(Access access, VkFormat format) {
  const auto only = [&](Access allowed) { return (uint32_t(access) & ~uint32_t(allowed)) == 0; };
  if (only(Access::sampled))
    return is_depth(format) ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL
                            : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  if (only(Access::sampled | Access::depth_test)) return VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
  if (only(Access::color)) return VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  if (only(Access::depth | Access::depth_test)) return VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
  if (only(Access::transfer_read)) return VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  if (only(Access::transfer_write)) return VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  return VK_IMAGE_LAYOUT_GENERAL;
}

}  // namespace

VkAccessFlags2 write_access(VkAccessFlags2 access) {
  return access & (VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                   VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
                   VK_ACCESS_2_HOST_WRITE_BIT);
}

Use use_of(Access access, PassKind kind, bool is_buffer, VkFormat format) {
  Use use;
  const auto add = [&](Access one, VkPipelineStageFlags2 stages, VkAccessFlags2 flags) {
    if (!has(access, one)) return;
    use.stages |= stages;
    use.access |= flags;
  };
  constexpr VkPipelineStageFlags2 depth_stages =
      VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  constexpr VkPipelineStageFlags2 color_stage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  constexpr VkPipelineStageFlags2 transfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
  const VkPipelineStageFlags2 shader = shader_stages(kind);
  add(Access::sampled, shader, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
  add(Access::storage_read, shader, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
  add(Access::storage_write, shader, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
  // blending and loading read the attachment
  add(Access::color, color_stage,
      VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
  add(Access::depth, depth_stages,
      VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT);
  add(Access::depth_test, depth_stages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT);
  add(Access::vertex, VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT);
  add(Access::indirect, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
  add(Access::transfer_read, transfer, VK_ACCESS_2_TRANSFER_READ_BIT);
  add(Access::transfer_write, transfer, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  add(Access::uniform, shader, VK_ACCESS_2_UNIFORM_READ_BIT);
  add(Access::host_write, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_WRITE_BIT);
  // with other flags: the pass' own use; that the host reads the result is the segment's business
  if (access == Access::host_read)
    use = {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, use.layout};
  if (!is_buffer && access != Access::host_read) use.layout = layout_of(access, format);
  return use;
}

VkImageUsageFlags image_usage_of(Access access) {
  VkImageUsageFlags usage = 0;
  if (has(access, Access::sampled)) usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
  if (has(access, Access::storage_read | Access::storage_write)) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
  if (has(access, Access::color)) usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (has(access, Access::depth | Access::depth_test)) usage |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  if (has(access, Access::transfer_read)) usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  if (has(access, Access::transfer_write)) usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  return usage;
}

VkBufferUsageFlags buffer_usage_of(Access access) {
  VkBufferUsageFlags usage = 0;
  if (has(access, Access::storage_read | Access::storage_write)) usage |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  if (has(access, Access::uniform)) usage |= VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
  if (has(access, Access::vertex)) usage |= VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
  if (has(access, Access::indirect)) usage |= VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
  if (has(access, Access::transfer_read)) usage |= VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  if (has(access, Access::transfer_write)) usage |= VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  return usage;
}

}  // namespace gnomon
