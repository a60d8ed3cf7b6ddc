// Makes compute and graphics pipelines.
#include "engine/vulkan/pipeline.h"

#include <algorithm>
#include <concepts>
#include <optional>

#include "engine/vulkan/pipeline_store.h"
#include "engine/vulkan/vertex.h"

namespace gnomon {
namespace {

using Words = std::vector<uint32_t>;  // SPIR-V

class Module {
 public:
  Module(VkDevice device, const Words& words) : device_(device) {
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

// A pipeline of the device's store, which keeps the device alive.
struct Owned {
  std::shared_ptr<Device> device;
  PipelineStore::Held pipeline;
};
Pipeline own(const std::shared_ptr<Device>& device, PipelineStore::Held pipeline, VkPipelineLayout layout,
             VkPipelineBindPoint point) {
  const VkPipeline handle = *pipeline;
  return {std::make_shared<Owned>(Owned{device, std::move(pipeline)}), handle, layout, point};
}

// All that a pipeline is made of, as bytes.
class Key {
 public:
  Key& add(const std::string& text) {
    add(text.size());
    bytes_ += text;
    return *this;
  }
  Key& add(const Words& words) {
    return add(std::string(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(uint32_t)));
  }
  Key& add(std::integral auto value) {
    const auto wide = uint64_t(value);
    bytes_.append(reinterpret_cast<const char*>(&wide), sizeof wide);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

void add_state(Key& key, const RasterState& state) {
  key.add(int(state.layout)).add(int(state.topology)).add(int(state.depth)).add(state.colors.size());
  for (const VkFormat color : state.colors) key.add(int(color));
  key.add(state.depth_test).add(state.depth_write).add(state.depth_clamp).add(int(state.depth_compare));
  key.add(int(state.blend)).add(state.color_write);
  const StencilOps& s = state.stencil;
  key.add(s.enable).add(int(s.compare)).add(s.reference);
  for (const VkStencilOp op : {s.front_pass, s.front_depth_fail, s.back_pass, s.back_depth_fail})
    key.add(int(op));
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
  if (layout != VertexLayout::normals) {
    in.attributes.push_back({2, 1, VK_FORMAT_R32G32_SFLOAT, offsetof(VertexAttributes, uv)});
    in.attributes.push_back({3, 1, VK_FORMAT_R16G16B16A16_UNORM, offsetof(VertexAttributes, color)});
  }
  if (layout != VertexLayout::masked)
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

VkPipeline compute_pipeline(const Device& device, VkPipelineLayout layout, const Words& words,
                            bool subgroup_size, VkPipelineCache cache) {
  const Module module(device.handle(), words);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT);
  info.layout = layout;
  VkPipelineShaderStageRequiredSubgroupSizeCreateInfo subgroup{
      VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO};
  subgroup.requiredSubgroupSize = device.subgroup_size();
  if (subgroup_size) info.stage.pNext = &subgroup;
  VkPipeline handle = VK_NULL_HANDLE;
  check(vkCreateComputePipelines(device.handle(), cache, 1, &info, nullptr, &handle),
        "vkCreateComputePipelines");
  return handle;
}

// Color attachments, and how they blend.
struct Blending {
  explicit Blending(const RasterState& state)
      : each(state.colors.size(), blend_state(state.blend, state.color_write)) {
    info.attachmentCount = uint32_t(each.size());
    info.pAttachments = each.data();
  }
  Blending(const Blending&) = delete;
  Blending& operator=(const Blending&) = delete;
  std::vector<VkPipelineColorBlendAttachmentState> each;
  VkPipelineColorBlendStateCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
};

VkPipelineRenderingCreateInfo rendering_info(const RasterState& state) {
  VkPipelineRenderingCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  info.colorAttachmentCount = uint32_t(state.colors.size());
  info.pColorAttachmentFormats = state.colors.data();
  info.depthAttachmentFormat = state.depth;
  info.stencilAttachmentFormat =
      state.depth == VK_FORMAT_D32_SFLOAT_S8_UINT ? state.depth : VK_FORMAT_UNDEFINED;
  return info;
}

VkPipeline raster_pipeline(const Device& device, VkPipelineLayout layout, const RasterState& state,
                           const std::vector<VkPipelineShaderStageCreateInfo>& stages,
                           VkPipelineCache cache) {
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
  const Blending blending(state);
  const VkDynamicState dynamic[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                    VK_DYNAMIC_STATE_CULL_MODE};
  VkPipelineDynamicStateCreateInfo dynamics{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamics.dynamicStateCount = uint32_t(std::size(dynamic));
  dynamics.pDynamicStates = dynamic;
  const VkPipelineRenderingCreateInfo rendering = rendering_info(state);

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
  info.stageCount = uint32_t(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &vertex_state;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth_stencil;
  info.pColorBlendState = &blending.info;
  info.pDynamicState = &dynamics;
  info.layout = layout;
  VkPipeline handle = VK_NULL_HANDLE;
  check(vkCreateGraphicsPipelines(device.handle(), cache, 1, &info, nullptr, &handle),
        "vkCreateGraphicsPipelines");
  return handle;
}

}  // namespace

// The preamble stands for the layout: set 1 is what it declares, and all else of a layout is the same for
// all.

Pipeline make_compute_pipeline(const std::shared_ptr<Device>& device, VkPipelineLayout layout,
                               const ShaderSource& source, VkPipelineCache cache) {
  const Words words = compile_shader(source);
  const bool subgroup_size = knows_subgroup_size(source.defines);
  const Key key =
      Key().add(int(VK_PIPELINE_BIND_POINT_COMPUTE)).add(source.preamble).add(words).add(subgroup_size);
  const auto make = [&] { return compute_pipeline(*device, layout, words, subgroup_size, cache); };
  return own(device, device->pipelines().get(key.bytes(), make), layout, VK_PIPELINE_BIND_POINT_COMPUTE);
}

Pipeline make_raster_pipeline(const std::shared_ptr<Device>& device, VkPipelineLayout layout,
                              const RasterState& state, const std::string& preamble, VkPipelineCache cache) {
  const Words vertex = compile_shader({state.vertex, ShaderStage::vertex, preamble, state.defines});
  Words fragment;
  if (!state.fragment.empty())
    fragment = compile_shader({state.fragment, ShaderStage::fragment, preamble, state.defines});
  Key key = Key().add(int(VK_PIPELINE_BIND_POINT_GRAPHICS)).add(preamble).add(vertex).add(fragment);
  add_state(key, state);
  const auto make = [&] {
    const Module vertex_module(device->handle(), vertex);
    std::optional<Module> fragment_module;
    std::vector<VkPipelineShaderStageCreateInfo> stages{vertex_module.stage(VK_SHADER_STAGE_VERTEX_BIT)};
    if (!fragment.empty())
      stages.push_back(
          fragment_module.emplace(device->handle(), fragment).stage(VK_SHADER_STAGE_FRAGMENT_BIT));
    return raster_pipeline(*device, layout, state, stages, cache);
  };
  return own(device, device->pipelines().get(key.bytes(), make), layout, VK_PIPELINE_BIND_POINT_GRAPHICS);
}

}  // namespace gnomon
