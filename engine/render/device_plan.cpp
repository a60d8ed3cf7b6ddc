// A plan on a device: resources and memory, and every node's layouts and descriptor sets.
#include "engine/render/device_plan.h"

#include <fmt/format.h>

#include <cstring>
#include <string>

#include "engine/base/error.h"
#include "engine/base/format.h"
#include "engine/render/preamble.h"
#include "engine/vulkan/commands.h"

namespace gnomon {
namespace {

void check_range(const Device& device, const Resource& r) {
  const uint64_t bytes = bytes_of(r.buffer), most = device.limits().maxStorageBufferRange;
  if (r.is_buffer && (r.buffer_usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) != 0 && bytes > most)
    fail(fmt::format("'{}' needs {} bytes", r.name, bytes), {}, {},
         fmt::format("this device's storage buffers have at most {} bytes: use a smaller scene", most));
}

// Not every device can render to signed normalised numbers; what reads them samples floats as well.
ImageShape on_device(const Device& device, const Resource& r) {
  ImageShape shape = r.image;
  if (shape.format != VK_FORMAT_R16G16_SNORM || (r.image_usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) == 0)
    return shape;
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(device.physical(), shape.format, &properties);
  if ((properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT) == 0)
    shape.format = VK_FORMAT_R32G32_SFLOAT;  // which every device can
  return shape;
}

Physical make_physical(const std::shared_ptr<Device>& device, const Resource& r, bool own_memory) {
  check_range(*device, r);
  Physical physical;
  if (r.is_buffer) {
    const uint64_t bytes =
        std::max<uint64_t>(r.buffer.count * r.buffer.stride, 16);  // Vulkan has no empty buffers
    const VkBufferUsageFlags fill = r.history ? VK_BUFFER_USAGE_TRANSFER_DST_BIT : 0;
    physical.buffer = Buffer(device, bytes, r.buffer_usage | fill,
                             r.host_visible || r.host_written ? Place::host : Place::device, own_memory);
    physical.views = std::make_shared<ViewSet>();
  } else {
    const VkImageUsageFlags fill = r.constant || r.history ? VK_IMAGE_USAGE_TRANSFER_DST_BIT : 0;
    physical.image = GpuImage(device, on_device(*device, r), r.image_usage | fill, own_memory);
  }
  return physical;
}

void add_image_barrier(std::vector<VkImageMemoryBarrier2>& out, const Barrier& b, const GpuImage& image) {
  VkImageMemoryBarrier2 v{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  v.srcStageMask = b.before.stages, v.srcAccessMask = b.before.access;
  v.dstStageMask = b.after.stages, v.dstAccessMask = b.after.access;
  v.oldLayout = b.discard ? VK_IMAGE_LAYOUT_UNDEFINED : b.before.layout;
  v.newLayout = b.after.layout;
  v.srcQueueFamilyIndex = v.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  v.image = image.handle();
  v.subresourceRange = {image.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
  out.push_back(v);
}

// Aliased memory is reached through other handles than the one in the barrier, so a discard is a memory
// barrier too.
VkMemoryBarrier2 memory_barrier(const Barrier& b) {
  VkMemoryBarrier2 v{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  v.srcStageMask = b.before.stages, v.srcAccessMask = b.before.access;
  v.dstStageMask = b.after.stages, v.dstAccessMask = b.after.access;
  return v;
}

VkDescriptorType descriptor_type(const Port& port) {
  if (has(port.access, Access::uniform)) return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  if (port.is_buffer) return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  return has(port.access, Access::sampled) ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                                           : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
}

// What shaders see of a port's image: all of it, or each mip level by itself.
std::vector<VkImageView> views_of(const Port& port, const GpuImage& image) {
  if (has(port.access, Access::sampled)) return {image.sampled_view(port.array)};
  const uint32_t levels = storage_levels(port);
  if (levels == 1) return {image.storage_view(port.array)};
  std::vector<VkImageView> views;
  const VkImageViewType type = port.array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  for (uint32_t level = 0; level < levels; ++level)
    views.push_back(image.view(type, 0, port.array ? image.shape().layers : 1, level, 1, image.aspect()));
  return views;
}

// What shaders do otherwise on this device.
std::string missing_text(const Device& device) {
  std::string text;
  if (!device.chooses_layers()) text += "#define LAYERS_ONE_BY_ONE 1\n";
  if (!device.numbers_triangles()) text += "#define NO_PRIMITIVE_NUMBER 1\n";
  return text;
}

// Of one node's storage images, and what the device shows to a shader at most.
void check_storage_images(const Device& device, const PlanNode& node) {
  uint32_t count = 0;
  for (const ShaderPort& shown : shader_ports(node.declaration))
    if (descriptor_type(*shown.port) == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE)
      count += storage_levels(*shown.port);
  const uint32_t most = device.limits().maxPerStageDescriptorStorageImages;
  if (count <= most) return;
  fail("pass '" + node.id + "' writes " + std::to_string(count) + " images or mip levels", {}, {},
       "this device shows a shader at most " + std::to_string(most) + ": use a smaller map");
}

}  // namespace

const Physical& physical_of(const PlanNode& node, const std::vector<Physical>& resources,
                            const std::string& port) {
  const auto found = node.resources.find(port);
  if (found == node.resources.end()) fail(fmt::format("pass '{}' has no port '{}'", node.id, port));
  return resources[found->second];
}

const ViewSet& views_of(const PlanNode& node, const std::vector<Physical>& resources,
                        const std::string& port) {
  const Physical& physical = physical_of(node, resources, port);
  if (!physical.views || physical.views->views.empty())
    fail(fmt::format("no views are known of '{}' of pass '{}'", port, node.id));
  return *physical.views;
}

MemoryNeed device_need(const std::shared_ptr<Device>& device, const Resource& r) {
  check_range(*device, r);
  const uint64_t granularity = device->limits().bufferImageGranularity;
  const VkMemoryRequirements need =
      r.is_buffer ? Buffer(device, std::max<uint64_t>(r.buffer.count * r.buffer.stride, 16), r.buffer_usage,
                           Place::device, false)
                        .requirements()
                  : GpuImage(device, on_device(*device, r), r.image_usage, false).requirements();
  return {need.size, std::max(need.alignment, granularity)};
}

DevicePlan::DevicePlan(std::shared_ptr<Device> device, const GpuScene& scene, const Plan& plan)
    : device_(std::move(device)), scene_(scene), plan_(plan) {
  VkSamplerCreateInfo nearest{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  nearest.addressModeU = nearest.addressModeV = nearest.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  nearest.maxLod = VK_LOD_CLAMP_NONE;
  sampler_ = create(device_, vkCreateSampler, nearest, vkDestroySampler, "vkCreateSampler");
  make_resources();
  make_nodes();
  fill_initial();
}

void DevicePlan::make_resources() {
  resources_.resize(plan_.resources.size());
  previous_.resize(plan_.resources.size());
  uint32_t types = ~0u;
  for (size_t i = 0; i < resources_.size(); ++i) {
    const Resource& r = plan_.resources[i];
    const bool own = r.size == 0;
    resources_[i] = make_physical(device_, r, own);
    if (r.history) previous_[i] = make_physical(device_, r, own);
    has_history_ = has_history_ || r.history;
    if (!own)
      types &= (r.is_buffer ? resources_[i].buffer.requirements() : resources_[i].image.requirements())
                   .memoryTypeBits;
  }
  if (plan_.heap_bytes == 0) return;
  heap_ = Memory(device_, plan_.heap_bytes, device_->memory_type(types, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT));
  for (size_t i = 0; i < resources_.size(); ++i) {
    const Resource& r = plan_.resources[i];
    if (r.size == 0) continue;
    if (r.is_buffer)
      resources_[i].buffer.bind(heap_.handle(), r.offset);
    else
      resources_[i].image.bind(heap_.handle(), r.offset);
  }
}

void DevicePlan::make_nodes() {
  uint32_t images = 1, storage_images = 1, buffers = 1, blocks = 0;
  for (const PlanNode& node : plan_.nodes)
    for (const ShaderPort& shown : shader_ports(node.declaration)) {
      if (has(shown.port->access, Access::uniform))
        ++blocks;
      else if (shown.port->is_buffer)
        ++buffers;
      else if (has(shown.port->access, Access::sampled))
        ++images;
      else
        storage_images += storage_levels(*shown.port);
    }
  const uint32_t copies = has_history_ ? 2 : 1;
  const uint32_t count = copies * (uint32_t(plan_.nodes.size()) + 1);
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, copies * images},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, copies * storage_images},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, copies * buffers},
                                        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, copies * blocks + count}};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.maxSets = count;
  info.poolSizeCount = uint32_t(std::size(sizes));
  info.pPoolSizes = sizes;
  pool_ = create(device_, vkCreateDescriptorPool, info, vkDestroyDescriptorPool, "vkCreateDescriptorPool");
  nodes_.resize(plan_.nodes.size());
  for (uint32_t i = 0; i < nodes_.size(); ++i) make_node(i);
}

void DevicePlan::make_node(uint32_t index) {
  const PlanNode& node = plan_.nodes[index];
  NodeState& state = nodes_[index];
  check_storage_images(*device_, node);
  state.preamble = missing_text(*device_) + light_kind_text(scene_.scene().lights) +
                   camera_kind_text(scene_.camera()) + preamble(node.declaration, node.constant_inputs);
  state.layers_at_once = device_->chooses_layers();
  const auto shown = shader_ports(node.declaration);
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const ShaderPort& s : shown)
    bindings.push_back(
        {s.binding, descriptor_type(*s.port), storage_levels(*s.port), VK_SHADER_STAGE_ALL, nullptr});
  const auto block = parameter_block(node.params);
  if (!block.empty()) {
    bindings.push_back(
        {uint32_t(shown.size()), VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr});
    state.parameters = Buffer(device_, block.size(), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Place::host);
    std::memcpy(state.parameters.bytes().data(), block.data(), block.size());
  }
  VkDescriptorSetLayoutCreateInfo layout{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  layout.bindingCount = uint32_t(bindings.size());
  layout.pBindings = bindings.data();
  state.set_layout = create(device_, vkCreateDescriptorSetLayout, layout, vkDestroyDescriptorSetLayout,
                            "vkCreateDescriptorSetLayout");
  const VkDescriptorSetLayout sets[] = {scene_.frame_layout(), state.set_layout.get(),
                                        scene_.material_layout()};
  const VkPushConstantRange push{VK_SHADER_STAGE_ALL, 0, 128};  // what every device_ has
  VkPipelineLayoutCreateInfo pipeline{
      VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 3, sets, 1, &push};
  state.pipeline_layout =
      create(device_, vkCreatePipelineLayout, pipeline, vkDestroyPipelineLayout, "vkCreatePipelineLayout");
  const VkDescriptorSetLayout set_layout = state.set_layout.get();
  VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool_.get(),
                                       1, &set_layout};
  check(vkAllocateDescriptorSets(device_->handle(), &allocate, &state.set), "vkAllocateDescriptorSets");
  write_set(node, state);
  if (!has_history_) return;
  // The other set is what this one would be with the two copies of history exchanged.
  std::swap(resources_, previous_);
  std::swap(state.set, state.other_set);
  check(vkAllocateDescriptorSets(device_->handle(), &allocate, &state.set), "vkAllocateDescriptorSets");
  write_set(node, state);
  std::swap(resources_, previous_);
  std::swap(state.set, state.other_set);
}

// While the other set is written the two lists are exchanged; what has no second copy is in one of them only.
const Physical& DevicePlan::physical_at(const PlanNode& node, const std::string& port) const {
  const uint32_t index = node.resources.at(port);
  const auto back = node.previous_inputs.find(port);
  const bool before = back != node.previous_inputs.end() && back->second;
  const Physical &first = before ? previous_[index] : resources_[index],
                 &second = before ? resources_[index] : previous_[index];
  return first.image || first.buffer ? first : second;
}

void DevicePlan::write_set(const PlanNode& node, NodeState& state) {
  const auto shown = shader_ports(node.declaration);
  for (const ShaderPort& s : shown) {
    const Physical& physical = physical_at(node, s.port->name);
    VkWriteDescriptorSet w{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, state.set, s.binding, 0, 1};
    w.descriptorType = descriptor_type(*s.port);
    VkDescriptorBufferInfo buffer{physical.buffer.handle(), 0, VK_WHOLE_SIZE};
    const uint64_t most = device_->limits().maxUniformBufferRange;
    if (has(s.port->access, Access::uniform) && physical.buffer.size() > most)
      fail(fmt::format("'{}' has {} bytes, and '{}' reads at most {} as a uniform block", s.port->name,
                       physical.buffer.size(), device_->info().name, most),
           {}, node.id);
    std::vector<VkDescriptorImageInfo> images;
    if (s.port->is_buffer) {
      w.pBufferInfo = &buffer;
    } else {
      const VkImageLayout layout =
          use_of(s.port->access, node.declaration.kind(), false, physical.image.shape().format).layout;
      for (const VkImageView view : views_of(*s.port, physical.image))
        images.push_back({sampler_.get(), view, layout});
      w.descriptorCount = uint32_t(images.size());
      w.pImageInfo = images.data();
    }
    vkUpdateDescriptorSets(device_->handle(), 1, &w, 0, nullptr);
  }
  if (!state.parameters) return;
  VkDescriptorBufferInfo buffer{state.parameters.handle(), 0, VK_WHOLE_SIZE};
  VkWriteDescriptorSet w{
      VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, state.set, uint32_t(shown.size()), 0, 1};
  w.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  w.pBufferInfo = &buffer;
  vkUpdateDescriptorSets(device_->handle(), 1, &w, 0, nullptr);
}

// Folded constants have their value and both copies of a history image are zero before the first frame; kept
// images have their layout.
void DevicePlan::fill_initial() {
  OneShot once(device_);
  for (size_t i = 0; i < resources_.size(); ++i) {
    const Resource& r = plan_.resources[i];
    if (r.kept && !r.is_buffer && r.initial_layout != VK_IMAGE_LAYOUT_UNDEFINED)
      change_layout(once.commands(), resources_[i].image, VK_IMAGE_LAYOUT_UNDEFINED, r.initial_layout);
    if (!r.constant && !r.history) continue;
    const auto value = r.constant.value_or(std::array<float, 4>{});
    for (const Physical* copy : {&resources_[i], &previous_[i]}) {
      if (copy->image) clear_image(once.commands(), copy->image, value, r.initial_layout);
      if (copy->buffer) vkCmdFillBuffer(once.commands(), copy->buffer.handle(), 0, VK_WHOLE_SIZE, 0);
    }
  }
  once.submit_and_wait();
}

void DevicePlan::forget() { fill_initial(); }

// The copies of the frame before become the ones to write.
void DevicePlan::swap_history() {
  if (!has_history_) return;
  for (size_t i = 0; i < resources_.size(); ++i)
    if (plan_.resources[i].history) std::swap(resources_[i], previous_[i]);
  for (NodeState& state : nodes_) std::swap(state.set, state.other_set);
}

void DevicePlan::barriers(VkCommandBuffer to, const std::vector<Barrier>& list, bool first_turn) const {
  std::vector<VkImageMemoryBarrier2> images;
  std::vector<VkMemoryBarrier2> memory;
  for (const Barrier& b : list) {
    if (b.once && !first_turn) continue;
    const Physical& physical = b.previous ? previous_[b.resource] : resources_[b.resource];
    if (physical.image) add_image_barrier(images, b, physical.image);
    if (!physical.image || b.discard) memory.push_back(memory_barrier(b));
  }
  if (memory.empty() && images.empty()) return;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = uint32_t(memory.size());
  info.pMemoryBarriers = memory.data();
  info.imageMemoryBarrierCount = uint32_t(images.size());
  info.pImageMemoryBarriers = images.data();
  vkCmdPipelineBarrier2(to, &info);
}

}  // namespace gnomon
