// Makes compute and graphics pipelines.
#include "engine/vulkan/pipeline.h"

#include <algorithm>
#include <optional>

#include "engine/vulkan/vertex.h"

namespace gnomon {
namespace {

class Module {
 public:
  Module(VkDevice device, const ShaderSource& source) : device_(device) {
    const auto words = compile_shader(source);
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = words.size() * 4;
    info.pCode = words.data();
    check(vkCreateShaderModule(device, &info, nullptr, &handle_), "vkCreateShaderModule");
  }
  ~Module() { vkDestroyShaderModule(device_, handle_, nullptr); }
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;
  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits bit) const {
    return {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, bit, handle_, "main", nullptr};
  }

 private:
  VkDevice device_;
  VkShaderModule handle_ = VK_NULL_HANDLE;
};

Pipeline own(const std::shared_ptr<Device>& device, VkPipeline handle, VkPipelineLayout layout,
             VkPipelineBindPoint point) {
  std::shared_ptr<void> owner(
      nullptr, [device, handle](void*) { vkDestroyPipeline(device->handle(), handle, nullptr); });
  return {std::move(owner), handle, layout, point};
}

struct VertexInput {
  std::vector<VkVertexInputBindingDescription> bindings;
  std::vector<VkVertexInputAttributeDescription> attributes;
};
VertexInput vertex_input(VertexLayout layout) {
  VertexInput in;
  if (layout == VertexLayout::none) return in;
  if (layout == VertexLayout::references) {
    in.bindings.push_back({0, 8, VK_VERTEX_INPUT_RATE_VERTEX});
    in.attributes.push_back({0, 0, VK_FORMAT_R32G32_UINT, 0});
    return in;
  }
  in.bindings.push_back({0, 12, VK_VERTEX_INPUT_RATE_VERTEX});
  in.attributes.push_back({0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0});
  if (layout == VertexLayout::positions) return in;
  in.bindings.push_back({1, sizeof(VertexAttributes), VK_VERTEX_INPUT_RATE_VERTEX});
  in.attributes.push_back({2, 1, VK_FORMAT_R32G32_SFLOAT, offsetof(VertexAttributes, uv)});
  in.attributes.push_back({3, 1, VK_FORMAT_R16G16B16A16_UNORM, offsetof(VertexAttributes, color)});
  if (layout == VertexLayout::masked) return in;
  in.attributes.push_back({1, 1, VK_FORMAT_R16G16_SNORM, offsetof(VertexAttributes, normal)});
  return in;
}

VkPipelineColorBlendAttachmentState blend_state(Blend blend, bool write) {
  VkPipelineColorBlendAttachmentState s{};
  s.colorWriteMask = write ? 0xF : 0;
  s.blendEnable = blend != Blend::none;
  s.srcColorBlendFactor = s.srcAlphaBlendFactor =
      blend == Blend::multiply ? VK_BLEND_FACTOR_ZERO : VK_BLEND_FACTOR_ONE;
  s.dstColorBlendFactor = s.dstAlphaBlendFactor =
      blend == Blend::multiply ? VK_BLEND_FACTOR_SRC_COLOR : VK_BLEND_FACTOR_ONE;
  s.colorBlendOp = s.alphaBlendOp = VK_BLEND_OP_ADD;
  return s;
}

VkPipelineDepthStencilStateCreateInfo depth_stencil_state(const RasterState& state) {
  VkPipelineDepthStencilStateCreateInfo s{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  s.depthTestEnable = state.depth_test;
  s.depthWriteEnable = state.depth_write;
  s.depthCompareOp = state.depth_compare;
  s.stencilTestEnable = state.stencil.enable;
  s.front = {VK_STENCIL_OP_KEEP,
             state.stencil.front_pass,
             state.stencil.front_depth_fail,
             state.stencil.compare,
             0xFF,
             0xFF,
             state.stencil.reference};
  s.back = {VK_STENCIL_OP_KEEP,
            state.stencil.back_pass,
            state.stencil.back_depth_fail,
            state.stencil.compare,
            0xFF,
            0xFF,
            state.stencil.reference};
  return s;
}

bool knows_subgroup_size(const Defines& defines) {
  return std::any_of(defines.begin(), defines.end(), [](const auto& d) { return d.first == kSubgroupSize; });
}

}  // namespace

Pipeline make_compute_pipeline(const std::shared_ptr<Device>& device, VkPipelineLayout layout,
                               const ShaderSource& source, VkPipelineCache cache) {
  const Module module(device->handle(), source);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT);
  info.layout = layout;
  VkPipelineShaderStageRequiredSubgroupSizeCreateInfo subgroup{
      VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO};
  subgroup.requiredSubgroupSize = device->subgroup_size();
  if (knows_subgroup_size(source.defines)) info.stage.pNext = &subgroup;
  VkPipeline handle = VK_NULL_HANDLE;
  check(vkCreateComputePipelines(device->handle(), cache, 1, &info, nullptr, &handle),
        "vkCreateComputePipelines");
  return own(device, handle, layout, VK_PIPELINE_BIND_POINT_COMPUTE);
}

Pipeline make_raster_pipeline(const std::shared_ptr<Device>& device, VkPipelineLayout layout,
                              const RasterState& state, const std::string& preamble, VkPipelineCache cache) {
  const Module vertex(device->handle(), {state.vertex, ShaderStage::vertex, preamble, state.defines});
  std::optional<Module> fragment;
  std::vector<VkPipelineShaderStageCreateInfo> stages{vertex.stage(VK_SHADER_STAGE_VERTEX_BIT)};
  if (!state.fragment.empty()) {
    fragment.emplace(device->handle(),
                     ShaderSource{state.fragment, ShaderStage::fragment, preamble, state.defines});
    stages.push_back(fragment->stage(VK_SHADER_STAGE_FRAGMENT_BIT));
  }

  const VertexInput in = vertex_input(state.layout);
  VkPipelineVertexInputStateCreateInfo vertex_state{
      VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  vertex_state.vertexBindingDescriptionCount = uint32_t(in.bindings.size());
  vertex_state.pVertexBindingDescriptions = in.bindings.data();
  vertex_state.vertexAttributeDescriptionCount = uint32_t(in.attributes.size());
  vertex_state.pVertexAttributeDescriptions = in.attributes.data();
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = state.topology;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.depthClampEnable = state.depth_clamp;
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  raster.lineWidth = 1.0f;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  const auto depth_stencil = depth_stencil_state(state);
  const std::vector<VkPipelineColorBlendAttachmentState> blends(state.colors.size(),
                                                                blend_state(state.blend, state.color_write));
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = uint32_t(blends.size());
  blend.pAttachments = blends.data();
  const VkDynamicState dynamic[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                    VK_DYNAMIC_STATE_CULL_MODE};
  VkPipelineDynamicStateCreateInfo dynamics{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamics.dynamicStateCount = uint32_t(std::size(dynamic));
  dynamics.pDynamicStates = dynamic;
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.colorAttachmentCount = uint32_t(state.colors.size());
  rendering.pColorAttachmentFormats = state.colors.data();
  rendering.depthAttachmentFormat = state.depth;
  rendering.stencilAttachmentFormat =
      state.depth == VK_FORMAT_D32_SFLOAT_S8_UINT ? state.depth : VK_FORMAT_UNDEFINED;

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
  info.stageCount = uint32_t(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &vertex_state;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth_stencil;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamics;
  info.layout = layout;
  VkPipeline handle = VK_NULL_HANDLE;
  check(vkCreateGraphicsPipelines(device->handle(), cache, 1, &info, nullptr, &handle),
        "vkCreateGraphicsPipelines");
  return own(device, handle, layout, VK_PIPELINE_BIND_POINT_GRAPHICS);
}

}  // namespace gnomon
