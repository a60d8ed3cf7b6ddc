// How passes record their commands.
#include "engine/render/context.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/light/view_set.h"
#include "engine/plan/compile_parts.h"
#include "engine/render/device_plan.h"
#include "engine/render/gpu_scene.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/occlusion_queries.h"

namespace gnomon {
namespace {

constexpr uint32_t kTile = 8;  // side of dispatch_over's workgroups, pixels

VkRenderingAttachmentInfo attachment(VkImageView view, VkImageLayout layout, bool clear) {
  VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  info.imageView = view;
  info.imageLayout = layout;
  info.loadOp = clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  return info;
}

// The layout that the plan keeps a port's image in while the pass runs.
VkImageLayout layout_of(const PlanNode& node, const std::string& name, VkFormat format) {
  const Port* port = node.declaration.find(name);
  return use_of(port->access, node.declaration.kind(), false, format).layout;
}

VkImageView target_view(const GpuImage& image, const Targets& targets, std::optional<uint32_t> own = {}) {
  if (own) return image.view(VK_IMAGE_VIEW_TYPE_2D, *own, 1, 0, 1, image.aspect());
  if (!targets.layer) return image.attachment_view();
  const uint32_t first = std::min(*targets.layer, image.shape().layers - 1);
  const VkImageViewType type = targets.layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  return image.view(type, first, targets.layers, 0, 1, image.aspect());
}

}  // namespace

Context::Context(VkCommandBuffer commands, const GpuScene& scene, const PlanNode& node,
                 const NodeState& state, const std::vector<Physical>& resources,
                 const std::vector<Physical>& previous, uint32_t iteration,
                 std::function<void(std::string_view)> section)
    : commands_(commands),
      scene_(scene),
      node_(node),
      state_(state),
      resources_(resources),
      previous_(previous),
      iteration_(iteration),
      section_(std::move(section)) {}

const Physical& Context::physical(const std::string& port) const {
  const auto back = node_.previous_inputs.find(port);
  return physical_of(node_, back != node_.previous_inputs.end() && back->second ? previous_ : resources_,
                     port);
}
const Params& Context::params() const { return node_.params; }
ImageShape Context::shape(const std::string& port) const { return physical(port).image.shape(); }
const Buffer& Context::buffer(const std::string& port) const { return physical(port).buffer; }

const ViewSet& Context::views(const std::string& port) const { return views_of(node_, resources_, port); }
void Context::publish(const std::string& port, ViewSet views) const {
  *physical(port).views = std::move(views);
}

void Context::bind(const Pipeline& pipeline) {
  vkCmdBindPipeline(commands_, pipeline.bind_point, pipeline.handle);
  const VkDescriptorSet sets[] = {scene_.frame_set(), state_.set};
  vkCmdBindDescriptorSets(commands_, pipeline.bind_point, pipeline.layout, 0, state_.set ? 2 : 1, sets, 0,
                          nullptr);
}

void Context::push_bytes(const Pipeline& pipeline, std::span<const std::byte> bytes, uint32_t offset) {
  vkCmdPushConstants(commands_, pipeline.layout, VK_SHADER_STAGE_ALL, offset, uint32_t(bytes.size()),
                     bytes.data());
}

void Context::dispatch(const Pipeline& pipeline, uint32_t x, uint32_t y, uint32_t z) {
  bind(pipeline);
  vkCmdDispatch(commands_, x, y, z);
}

void Context::dispatch_over(const Pipeline& pipeline, Extent pixels, uint32_t layers) {
  dispatch(pipeline, (pixels.width + kTile - 1) / kTile, (pixels.height + kTile - 1) / kTile, layers);
}

void Context::dispatch_indirect(const Pipeline& pipeline, const std::string& port, uint64_t offset) {
  bind(pipeline);
  vkCmdDispatchIndirect(commands_, physical(port).buffer.handle(), offset);
}

void Context::fill(const std::string& buffer_port, uint32_t value, uint64_t offset, uint64_t size) {
  vkCmdFillBuffer(commands_, physical(buffer_port).buffer.handle(), offset, size, value);
}

void Context::update(const std::string& buffer_port, std::span<const std::byte> bytes, uint64_t offset) {
  vkCmdUpdateBuffer(commands_, physical(buffer_port).buffer.handle(), offset, bytes.size(), bytes.data());
}

void Context::clear(const std::string& image_port, uint32_t value) {
  const GpuImage& image = physical(image_port).image;
  VkClearColorValue color;
  std::fill(std::begin(color.uint32), std::end(color.uint32), value);
  const VkImageSubresourceRange all{image.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
  vkCmdClearColorImage(commands_, image.handle(), layout_of(node_, image_port, image.shape().format), &color,
                       1, &all);
}

void Context::copy(const Buffer& from, const std::string& image_port) {
  const ImageShape shape = physical(image_port).image.shape();
  copy_region(from, image_port, {0, 0, shape.extent.height}, shape.layers);
}

void Context::copy_rows(const Buffer& from, const std::string& image_port, const Rows& rows) {
  copy_region(from, image_port, rows, 1);
}

void Context::copy_region(const Buffer& from, const std::string& image_port, const Rows& rows,
                          uint32_t layers) {
  const GpuImage& image = physical(image_port).image;
  VkBufferImageCopy region{};
  region.imageSubresource = {image.aspect(), 0, rows.layer, layers};
  region.imageOffset.y = int32_t(rows.first);
  region.imageExtent = {image.shape().extent.width, rows.count, 1};
  vkCmdCopyBufferToImage(commands_, from.handle(), image.handle(),
                         layout_of(node_, image_port, image.shape().format), 1, &region);
}

void Context::generate_mips(const std::string& port) {
  gnomon::generate_mips(commands_, physical(port).image);
}

void Context::own_barrier() { full_barrier(commands_); }

uint32_t Context::layers_of(const Targets& targets) const {
  uint32_t layers = 1;
  const auto note = [&](const std::string& port) {
    layers = targets.layer ? targets.layers : physical(port).image.shape().layers;
  };
  for (const ColorTarget& target : targets.colors) {
    note(target.port);
    if (target.layer) layers = 1;
  }
  if (targets.depth) note(targets.depth->port);
  return layers;
}

void Context::render(const Targets& targets, const std::function<void()>& body) {
  const uint32_t layers = layers_of(targets);
  if (layers == 1 || state_.layers_at_once) return render_layers(targets, layers, body);
  Targets one = targets;
  one.layers = 1;
  for (uint32_t i = 0; i < layers; ++i) {
    one.layer = targets.layer.value_or(0) + i;
    layer_ = i;
    render_layers(one, 1, body);
  }
  layer_.reset();
}

void Context::render_layers(const Targets& targets, uint32_t layers, const std::function<void()>& body) {
  std::vector<VkRenderingAttachmentInfo> colors;
  Extent area;
  for (const ColorTarget& target : targets.colors) {
    const GpuImage& image = physical(target.port).image;
    area = image.shape().extent;
    auto info = attachment(target_view(image, targets, target.layer),
                           layout_of(node_, target.port, image.shape().format), target.clear.has_value());
    if (target.clear) std::copy(target.clear->begin(), target.clear->end(), info.clearValue.color.float32);
    colors.push_back(info);
  }
  VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  bool stencil = false;
  if (targets.depth) {
    const GpuImage& image = physical(targets.depth->port).image;
    area = image.shape().extent;
    stencil = image.aspect() & VK_IMAGE_ASPECT_STENCIL_BIT;
    depth =
        attachment(target_view(image, targets), layout_of(node_, targets.depth->port, image.shape().format),
                   targets.depth->clear.has_value());
    const Access access = node_.declaration.find(targets.depth->port)->access;
    if (!has(access, Access::depth)) depth.storeOp = VK_ATTACHMENT_STORE_OP_NONE;  // planned as a read
    depth.clearValue.depthStencil = {targets.depth->clear.value_or(0.0f), targets.depth->clear_stencil};
  }
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea = {{0, 0}, {area.width, area.height}};
  info.layerCount = layers;
  info.colorAttachmentCount = uint32_t(colors.size());
  info.pColorAttachments = colors.data();
  info.pDepthAttachment = targets.depth ? &depth : nullptr;
  info.pStencilAttachment = stencil ? &depth : nullptr;
  vkCmdBeginRendering(commands_, &info);
  set_area(area);
  set_cull(VK_CULL_MODE_NONE);
  body();
  vkCmdEndRendering(commands_);
}

void Context::set_area(Extent extent) {
  const VkViewport viewport{0, 0, float(extent.width), float(extent.height), 0, 1};
  const VkRect2D scissor{{0, 0}, {extent.width, extent.height}};
  vkCmdSetViewport(commands_, 0, 1, &viewport);
  vkCmdSetScissor(commands_, 0, 1, &scissor);
}

void Context::set_cull(VkCullModeFlags mode) { vkCmdSetCullMode(commands_, mode); }

void Context::bind_geometry() {
  if (scene_.scene().meshes.empty())
    fail(fmt::format("pass '{}' draws the scene, and there is none", node_.id));
  const VkBuffer buffers[] = {scene_.positions(), scene_.attributes()};
  const VkDeviceSize offsets[] = {0, 0};
  vkCmdBindVertexBuffers(commands_, 0, 2, buffers, offsets);
  vkCmdBindIndexBuffer(commands_, scene_.indices(), 0, VK_INDEX_TYPE_UINT32);
}

void Context::draw(const Draw& draw, const LayerRun& all) {
  LayerRun layers = all;
  if (layer_) {
    if (*layer_ < all.first || *layer_ - all.first >= all.count) return;
    layers = {*layer_, 1};
  }
  const uint32_t indices[] = {draw.instance, draw.material};
  vkCmdPushConstants(commands_, state_.pipeline_layout.get(), VK_SHADER_STAGE_ALL, 0, sizeof(indices),
                     indices);
  vkCmdDrawIndexed(commands_, draw.index_count, layers.count, draw.first_index, draw.vertex_offset,
                   layers.first);
}

void Context::draw_scene(const ScenePipelines& pipelines, Cull cull, uint32_t layers) {
  const LayerRun all{0, layers};
  draw_scene(pipelines, cull, [&](const Draw&) { return std::span(&all, 1); });
}

void Context::draw_scene(const ScenePipelines& pipelines, Cull cull, const InstanceLayers& layers) {
  draw_scene(pipelines, cull, [&](const Draw& d) { return std::span(layers[d.instance]); });
}

void Context::draw_scene(const ScenePipelines& pipelines, Cull cull,
                         const std::function<std::span<const LayerRun>(const Draw&)>& layers_of) {
  bind_geometry();
  for (const bool masked : {false, true}) {
    const Pipeline* bound = nullptr;
    VkCullModeFlags current = VK_CULL_MODE_FLAG_BITS_MAX_ENUM;
    for (const Draw& d : scene_.draws()) {
      const std::span<const LayerRun> runs = layers_of(d);
      const bool plain = d.plain && pipelines.plain.handle;
      const Pipeline& pipeline = masked ? pipelines.masked : plain ? pipelines.plain : pipelines.opaque;
      if (d.alpha_masked != masked || !pipeline.handle || runs.empty()) continue;
      if (bound != &pipeline) bind(pipeline), bound = &pipeline;
      const bool one_sided = cull != Cull::none && !d.double_sided;
      const bool back = (cull == Cull::material) != d.mirrored;  // a mirrored instance turns the winding over
      const VkCullModeFlags mode = !one_sided ? VK_CULL_MODE_NONE
                                   : back     ? VK_CULL_MODE_BACK_BIT
                                              : VK_CULL_MODE_FRONT_BIT;
      if (mode != current) set_cull(mode), current = mode;
      const VkDescriptorSet material = scene_.material_set(d.material);
      vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout, 2, 1, &material, 0,
                              nullptr);
      for (const LayerRun& run : runs) draw(d, run);
    }
  }
}

void Context::reset(const OcclusionQueries& queries) {
  vkCmdResetQueryPool(commands_, queries.pool(), 0, queries.count());
}

void Context::query(const OcclusionQueries& queries, uint32_t index, const std::function<void()>& draws) {
  vkCmdBeginQuery(commands_, queries.pool(), index, 0);
  draws();
  vkCmdEndQuery(commands_, queries.pool(), index);
}

void Context::results(const OcclusionQueries& queries, uint32_t count, const std::string& buffer_port) {
  constexpr VkDeviceSize kStride = 8;  // bytes: two words
  vkCmdCopyQueryPoolResults(commands_, queries.pool(), 0, count, physical(buffer_port).buffer.handle(), 0,
                            kStride, VK_QUERY_RESULT_WAIT_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT);
}

void Context::draw_fullscreen(const Pipeline& pipeline) {
  bind(pipeline);
  set_cull(VK_CULL_MODE_NONE);
  vkCmdDraw(commands_, 3, 1, 0, 0);
}

void Context::draw_indirect(const Pipeline& pipeline, const std::string& port, uint64_t offset) {
  bind(pipeline);
  set_cull(VK_CULL_MODE_NONE);
  vkCmdDrawIndirect(commands_, physical(port).buffer.handle(), offset, 1, sizeof(VkDrawIndirectCommand));
}

void Context::bind_vertices(const std::string& buffer_port, uint64_t offset) {
  const VkBuffer buffer = physical(buffer_port).buffer.handle();
  vkCmdBindVertexBuffers(commands_, 0, 1, &buffer, &offset);
}

}  // namespace gnomon
