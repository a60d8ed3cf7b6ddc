#include "engine/renderer.h"

#include <fmt/format.h>

#include <chrono>
#include <cstring>

#include "engine/compile.h"
#include "engine/context.h"
#include "engine/error.h"
#include "engine/handle.h"
#include "engine/preamble.h"
#include "engine/readback.h"
#include "engine/timing.h"

namespace gnomon {
namespace {

using Clock = std::chrono::steady_clock;
double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// A wait that never ends is an error, not a hang. Generous: software devices run slow frames.
constexpr uint64_t kFenceTimeoutNs = 600ull * 1000 * 1000 * 1000;

MemoryNeed device_need(const std::shared_ptr<Device>& device, const Resource& r) {
  const uint64_t granularity = device->limits().bufferImageGranularity;
  const VkMemoryRequirements need =
      r.is_buffer ? Buffer(device, std::max<uint64_t>(r.buffer.count * r.buffer.stride, 16), r.buffer_usage,
                           Place::device, false)
                        .requirements()
                  : GpuImage(device, r.image, r.image_usage, false).requirements();
  return {need.size, std::max(need.alignment, granularity)};
}

Physical make_physical(const std::shared_ptr<Device>& device, const Resource& r, bool own_memory) {
  Physical physical;
  if (r.is_buffer) {
    const uint64_t bytes =
        std::max<uint64_t>(r.buffer.count * r.buffer.stride, 16);  // Vulkan has no empty buffers
    const VkBufferUsageFlags fill = r.history ? VK_BUFFER_USAGE_TRANSFER_DST_BIT : 0;
    physical.buffer = Buffer(device, bytes, r.buffer_usage | fill,
                             r.host_visible ? Place::host : Place::device, own_memory);
  } else {
    const VkImageUsageFlags fill = r.constant || r.history ? VK_IMAGE_USAGE_TRANSFER_DST_BIT : 0;
    physical.image = GpuImage(device, r.image, r.image_usage | fill, own_memory);
  }
  return physical;
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

}  // namespace

struct Renderer::Impl {
  Impl(std::shared_ptr<Device> d, std::shared_ptr<const Scene> s, const Graph& graph,
       const RenderSettings& settings);
  ~Impl();

  void make_resources();
  void make_nodes();
  void make_node(uint32_t index);
  void fill_initial();
  void swap_history();
  void prepare();
  const Physical& physical_at(const PlanNode& node, const std::string& port) const;
  void write_set(const PlanNode& node, NodeState& state);

  FrameTiming render(TimingMode mode);
  void run_segments(uint32_t first, uint32_t last, uint32_t iteration, TimingMode mode, FrameTiming& timing);
  void submit(const Segment& segment, uint32_t iteration, bool repeat, TimingMode mode, FrameTiming& timing);
  void record(const Segment& segment, uint32_t iteration, bool repeat, TimingMode mode,
              std::vector<double>& cpu_ms);
  void execute(const Segment& segment);
  void run_loop(const LoopPlan& loop, TimingMode mode, FrameTiming& timing);
  void barriers(VkCommandBuffer commands, const std::vector<Barrier>& list, bool first_turn = true) const;
  HostView host_view(const PlanNode& node, uint32_t iteration) const;

  std::shared_ptr<Device> device;
  std::shared_ptr<const Scene> scene;
  RenderSettings settings;
  GpuScene gpu_scene;
  Plan plan;
  Memory heap;
  // After heap, so destroyed first. `previous`: a history resource's copy of the frame before; empty for
  // others.
  std::vector<Physical> resources, previous;
  bool has_history = false;
  std::vector<NodeState> nodes;
  Handle<VkDescriptorPool> pool;
  Handle<VkPipelineCache> cache;
  Handle<VkSampler> sampler;
  Handle<VkCommandPool> command_pool;
  VkCommandBuffer commands = VK_NULL_HANDLE;  // of the pool
  Handle<VkFence> fence;
  std::unique_ptr<Timestamps> stamps;
  std::map<std::string, double> facts;
  std::vector<std::string> warnings;
  uint32_t frame = 0;
};

Renderer::Impl::Impl(std::shared_ptr<Device> d, std::shared_ptr<const Scene> s, const Graph& graph,
                     const RenderSettings& r)
    : device(std::move(d)), scene(std::move(s)), settings(r), gpu_scene(device, scene) {
  if (settings.camera >= scene->cameras.size())
    fail(fmt::format("the scene has {} camera(s), number {} is asked for", scene->cameras.size(),
                     settings.camera),
         scene->file.string(), "--camera", "cameras are counted from 0");
  const Camera& camera = scene->cameras[settings.camera];
  const Declaration::Setting setting{
      {settings.width, settings.height}, uint32_t(scene->lights.size()), uint32_t(gpu_scene.faces().size())};
  CompileOptions options;
  options.alias = settings.alias;
  options.keep_all = settings.keep_all;
  options.captures = settings.captures;
  options.memory = [this](const Resource& resource) { return device_need(device, resource); };
  const double aspect = camera.aspect.value_or(double(settings.width) / settings.height);
  plan = compile(graph, setting, scene_facts(*scene, camera, aspect), options);
  gpu_scene.update(settings.camera, settings.width, settings.height, settings.reversed_z, 0);

  VkSamplerCreateInfo nearest{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  nearest.addressModeU = nearest.addressModeV = nearest.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  nearest.maxLod = VK_LOD_CLAMP_NONE;
  sampler = create(device, vkCreateSampler, nearest, vkDestroySampler, "vkCreateSampler");
  VkPipelineCacheCreateInfo cache_info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  cache = create(device, vkCreatePipelineCache, cache_info, vkDestroyPipelineCache, "vkCreatePipelineCache");
  VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool_info.queueFamilyIndex = device->queue_family();
  command_pool = create(device, vkCreateCommandPool, pool_info, vkDestroyCommandPool, "vkCreateCommandPool");
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr,
                                       command_pool.get(), VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  check(vkAllocateCommandBuffers(device->handle(), &allocate, &commands), "vkAllocateCommandBuffers");
  VkFenceCreateInfo fence_info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  fence = create(device, vkCreateFence, fence_info, vkDestroyFence, "vkCreateFence");
  stamps = std::make_unique<Timestamps>(device, uint32_t(plan.nodes.size()) + 1);

  make_resources();
  make_nodes();
  fill_initial();
  prepare();
}

Renderer::Impl::~Impl() { vkDeviceWaitIdle(device->handle()); }

void Renderer::Impl::make_resources() {
  resources.resize(plan.resources.size());
  previous.resize(plan.resources.size());
  uint32_t types = ~0u;
  for (size_t i = 0; i < resources.size(); ++i) {
    const Resource& r = plan.resources[i];
    const bool own = r.size == 0;
    resources[i] = make_physical(device, r, own);
    if (r.history) previous[i] = make_physical(device, r, own);
    has_history = has_history || r.history;
    if (!own)
      types &= (r.is_buffer ? resources[i].buffer.requirements() : resources[i].image.requirements())
                   .memoryTypeBits;
  }
  if (plan.heap_bytes == 0) return;
  heap = Memory(device, plan.heap_bytes, device->memory_type(types, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT));
  for (size_t i = 0; i < resources.size(); ++i) {
    const Resource& r = plan.resources[i];
    if (r.size == 0) continue;
    if (r.is_buffer)
      resources[i].buffer.bind(heap.handle(), r.offset);
    else
      resources[i].image.bind(heap.handle(), r.offset);
  }
}

void Renderer::Impl::make_nodes() {
  uint32_t images = 1, storage_images = 1, buffers = 1;
  for (const PlanNode& node : plan.nodes)
    for (const ShaderPort& shown : shader_ports(node.declaration)) {
      if (shown.port->is_buffer)
        ++buffers;
      else if (has(shown.port->access, Access::sampled))
        ++images;
      else
        ++storage_images;
    }
  const uint32_t copies = has_history ? 2 : 1;
  const uint32_t count = copies * (uint32_t(plan.nodes.size()) + 1);
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, copies * images},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, copies * storage_images},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, copies * buffers},
                                        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, count}};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.maxSets = count;
  info.poolSizeCount = uint32_t(std::size(sizes));
  info.pPoolSizes = sizes;
  pool = create(device, vkCreateDescriptorPool, info, vkDestroyDescriptorPool, "vkCreateDescriptorPool");
  nodes.resize(plan.nodes.size());
  for (uint32_t i = 0; i < nodes.size(); ++i) make_node(i);
}

VkDescriptorType descriptor_type(const Port& port) {
  if (port.is_buffer) return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  return has(port.access, Access::sampled) ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                                           : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
}

void Renderer::Impl::make_node(uint32_t index) {
  const PlanNode& node = plan.nodes[index];
  NodeState& state = nodes[index];
  state.preamble = preamble(node.declaration, node.constant_inputs);
  const auto shown = shader_ports(node.declaration);
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const ShaderPort& s : shown)
    bindings.push_back({s.binding, descriptor_type(*s.port), 1, VK_SHADER_STAGE_ALL, nullptr});
  const auto block = parameter_block(node.params);
  if (!block.empty()) {
    bindings.push_back(
        {uint32_t(shown.size()), VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr});
    state.parameters = Buffer(device, block.size(), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Place::host);
    std::memcpy(state.parameters.bytes().data(), block.data(), block.size());
  }
  VkDescriptorSetLayoutCreateInfo layout{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  layout.bindingCount = uint32_t(bindings.size());
  layout.pBindings = bindings.data();
  state.set_layout = create(device, vkCreateDescriptorSetLayout, layout, vkDestroyDescriptorSetLayout,
                            "vkCreateDescriptorSetLayout");
  const VkDescriptorSetLayout sets[] = {gpu_scene.frame_layout(), state.set_layout.get(),
                                        gpu_scene.material_layout()};
  const VkPushConstantRange push{VK_SHADER_STAGE_ALL, 0, 128};  // what every device has
  VkPipelineLayoutCreateInfo pipeline{
      VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 3, sets, 1, &push};
  state.pipeline_layout =
      create(device, vkCreatePipelineLayout, pipeline, vkDestroyPipelineLayout, "vkCreatePipelineLayout");
  const VkDescriptorSetLayout set_layout = state.set_layout.get();
  VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool.get(), 1,
                                       &set_layout};
  check(vkAllocateDescriptorSets(device->handle(), &allocate, &state.set), "vkAllocateDescriptorSets");
  write_set(node, state);
  if (!has_history) return;
  // The other set is what this one would be with the two copies of history exchanged.
  std::swap(resources, previous);
  std::swap(state.set, state.other_set);
  check(vkAllocateDescriptorSets(device->handle(), &allocate, &state.set), "vkAllocateDescriptorSets");
  write_set(node, state);
  std::swap(resources, previous);
  std::swap(state.set, state.other_set);
}

// While the other set is written the two lists are exchanged; what has no second copy is in one of them only.
const Physical& Renderer::Impl::physical_at(const PlanNode& node, const std::string& port) const {
  const uint32_t index = node.resources.at(port);
  const auto back = node.previous_inputs.find(port);
  const bool before = back != node.previous_inputs.end() && back->second;
  const Physical &first = before ? previous[index] : resources[index],
                 &second = before ? resources[index] : previous[index];
  return first.image || first.buffer ? first : second;
}

void Renderer::Impl::write_set(const PlanNode& node, NodeState& state) {
  const auto shown = shader_ports(node.declaration);
  for (const ShaderPort& s : shown) {
    const Physical& physical = physical_at(node, s.port->name);
    VkWriteDescriptorSet w{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, state.set, s.binding, 0, 1};
    w.descriptorType = descriptor_type(*s.port);
    VkDescriptorImageInfo image{sampler.get(), VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED};
    VkDescriptorBufferInfo buffer{physical.buffer.handle(), 0, VK_WHOLE_SIZE};
    if (s.port->is_buffer) {
      w.pBufferInfo = &buffer;
    } else {
      const bool sampled = has(s.port->access, Access::sampled);
      image.imageView =
          sampled ? physical.image.sampled_view(s.port->array) : physical.image.storage_view(s.port->array);
      image.imageLayout =
          use_of(s.port->access, node.declaration.kind(), false, physical.image.shape().format).layout;
      w.pImageInfo = &image;
    }
    vkUpdateDescriptorSets(device->handle(), 1, &w, 0, nullptr);
  }
  if (!state.parameters) return;
  VkDescriptorBufferInfo buffer{state.parameters.handle(), 0, VK_WHOLE_SIZE};
  VkWriteDescriptorSet w{
      VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, state.set, uint32_t(shown.size()), 0, 1};
  w.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  w.pBufferInfo = &buffer;
  vkUpdateDescriptorSets(device->handle(), 1, &w, 0, nullptr);
}

// Folded constants have their value and both copies of a history image are zero before the first frame.
void Renderer::Impl::fill_initial() {
  OneShot once(device);
  for (size_t i = 0; i < resources.size(); ++i) {
    const Resource& r = plan.resources[i];
    if (!r.constant && !r.history) continue;
    const auto value = r.constant.value_or(std::array<float, 4>{});
    for (const Physical* copy : {&resources[i], &previous[i]}) {
      if (copy->image) clear_image(once.commands(), copy->image, value, r.initial_layout);
      if (copy->buffer) vkCmdFillBuffer(once.commands(), copy->buffer.handle(), 0, VK_WHOLE_SIZE, 0);
    }
  }
  once.submit_and_wait();
}

// The copies of the frame before become the ones to write.
void Renderer::Impl::swap_history() {
  if (!has_history) return;
  for (size_t i = 0; i < resources.size(); ++i)
    if (plan.resources[i].history) std::swap(resources[i], previous[i]);
  for (NodeState& state : nodes) std::swap(state.set, state.other_set);
}

void Renderer::Impl::prepare() {
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    Environment environment(device, gpu_scene, settings, plan.nodes[i], nodes[i], resources, cache.get());
    plan.nodes[i].pass->prepare(environment);
    facts.insert(environment.facts().begin(), environment.facts().end());
    warnings.insert(warnings.end(), environment.warnings().begin(), environment.warnings().end());
  }
}

void Renderer::Impl::barriers(VkCommandBuffer to, const std::vector<Barrier>& list, bool first_turn) const {
  std::vector<VkImageMemoryBarrier2> images;
  std::vector<VkMemoryBarrier2> memory;
  for (const Barrier& b : list) {
    if (b.once && !first_turn) continue;
    const Physical& physical = b.previous ? previous[b.resource] : resources[b.resource];
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

FrameTiming Renderer::Impl::render(TimingMode mode) {
  FrameTiming timing;
  const auto start = Clock::now();
  if (frame > 0) swap_history();
  gpu_scene.update(settings.camera, settings.width, settings.height, settings.reversed_z, frame++);
  uint32_t segment = 0;
  while (segment < plan.segments.size()) {
    const LoopPlan* loop = nullptr;
    uint32_t next_loop = uint32_t(plan.segments.size());
    for (const LoopPlan& l : plan.loops) {
      if (l.first_segment == segment) loop = &l;
      if (l.first_segment >= segment) next_loop = std::min(next_loop, l.first_segment);
    }
    if (loop) {
      run_loop(*loop, mode, timing);
      segment = loop->last_segment;
    } else {
      run_segments(segment, next_loop, 0, mode, timing);
      segment = next_loop;
    }
  }
  timing.frame_ms = ms_since(start);
  return timing;
}

void Renderer::Impl::run_segments(uint32_t first, uint32_t last, uint32_t iteration, TimingMode mode,
                                  FrameTiming& timing) {
  for (uint32_t s = first; s < last; ++s)
    submit(plan.segments[s], iteration, iteration > 0 && s == first, mode, timing);
}

void Renderer::Impl::run_loop(const LoopPlan& loop, TimingMode mode, FrameTiming& timing) {
  for (uint32_t iteration = 0; iteration < loop.max; ++iteration) {
    run_segments(loop.first_segment, loop.last_segment, iteration, mode, timing);
    const PlanNode& controller = plan.nodes[loop.controller];
    if (controller.pass->decide(host_view(controller, iteration)) == Step::done) break;
  }
}

HostView Renderer::Impl::host_view(const PlanNode& node, uint32_t iteration) const {
  return {iteration, [this, &node](std::string_view port) -> std::span<const std::byte> {
            if (!node.resources.contains(std::string(port)))
              fail(fmt::format("pass '{}' has no port '{}'", node.id, port));
            return physical_at(node, std::string(port)).buffer.bytes();
          }};
}

void Renderer::Impl::record(const Segment& segment, uint32_t iteration, bool repeat, TimingMode mode,
                            std::vector<double>& cpu_ms) {
  check(vkResetCommandPool(device->handle(), command_pool.get(), 0), "vkResetCommandPool");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  const bool stamped = mode != TimingMode::none, alone = mode == TimingMode::isolated;
  if (stamped) stamps->reset(commands), stamps->stamp(commands, alone);
  for (const LoopPlan& loop : plan.loops)
    if (repeat && plan.segments[loop.first_segment].first == segment.first)
      barriers(commands, loop.repeat_barriers);
  for (uint32_t i = segment.first; i < segment.last; ++i) {
    const auto start = Clock::now();
    barriers(commands, plan.nodes[i].barriers, iteration == 0);
    Context context(commands, gpu_scene, plan.nodes[i], nodes[i], resources, previous, iteration);
    plan.nodes[i].pass->record(context);
    if (stamped) stamps->stamp(commands, alone);
    cpu_ms.push_back(ms_since(start));
  }
  barriers(commands, segment.end_barriers);
  if (segment.last == plan.nodes.size()) barriers(commands, plan.final_barriers);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
}

void Renderer::Impl::execute(const Segment& segment) {
  VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands;
  const VkFence done = fence.get();
  check(vkResetFences(device->handle(), 1, &done), "vkResetFences");
  check(vkQueueSubmit(device->queue(), 1, &info, done), "vkQueueSubmit");
  const VkResult waited = vkWaitForFences(device->handle(), 1, &done, VK_TRUE, kFenceTimeoutNs);
  if (waited == VK_TIMEOUT)
    fail("the device did not finish a frame in ten minutes", {}, plan.nodes[segment.first].id);
  check(waited, "vkWaitForFences");
}

void Renderer::Impl::submit(const Segment& segment, uint32_t iteration, bool repeat, TimingMode mode,
                            FrameTiming& timing) {
  std::vector<double> cpu_ms;
  const auto record_start = Clock::now();
  record(segment, iteration, repeat, mode, cpu_ms);
  timing.record_ms += ms_since(record_start);
  const auto wait_start = Clock::now();
  execute(segment);
  const double wait_ms = ms_since(wait_start);
  if (mode == TimingMode::none) return;
  const auto at = stamps->read();
  timing.gpu_ms += at.back() - at.front();
  for (uint32_t i = segment.first; i < segment.last; ++i) {
    const uint32_t k = i - segment.first;
    const bool waited_for = segment.host_wait && i + 1 == segment.last;
    timing.passes.push_back({plan.nodes[i].id, plan.nodes[i].type, iteration, at[k + 1] - at[k], cpu_ms[k],
                             waited_for ? wait_ms : 0.0});
  }
}

Renderer::Renderer(std::shared_ptr<Device> device, std::shared_ptr<const Scene> scene, const Graph& graph,
                   const RenderSettings& settings)
    : impl_(std::make_unique<Impl>(std::move(device), std::move(scene), graph, settings)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

FrameTiming Renderer::render(TimingMode mode) { return impl_->render(mode); }

Image Renderer::read(const std::string& output) {
  const Plan& plan = impl_->plan;
  auto found = plan.outputs.find(output);
  if (found == plan.outputs.end()) {
    found = plan.captures.find(output);
    if (found == plan.captures.end()) fail(fmt::format("no output or captured port '{}'", output));
  }
  const Resource& resource = plan.resources[found->second];
  if (resource.is_buffer) fail(fmt::format("'{}' is a buffer: only images can be captured", output));
  const Extent shown =
      resource.constant ? Extent{impl_->settings.width, impl_->settings.height} : resource.image.extent;
  return read_back(impl_->device, impl_->resources[found->second].image, shown);
}

MemoryUse Renderer::memory() const {
  return {impl_->device->peak_bytes(), impl_->plan.heap_bytes, impl_->plan.heap_bytes_without_aliasing};
}
std::vector<LeftOutPass> Renderer::left_out() const {
  std::vector<LeftOutPass> result;
  for (const LeftOut& l : impl_->plan.left_out) result.push_back({l.id, l.reason});
  return result;
}
std::vector<std::string> Renderer::warnings() const { return impl_->warnings; }
std::map<std::string, double> Renderer::facts() const { return impl_->facts; }
std::string Renderer::plan_text() const { return to_text(impl_->plan); }
std::vector<std::string> Renderer::passes() const {
  std::vector<std::string> ids;
  for (const PlanNode& node : impl_->plan.nodes) ids.push_back(node.id);
  return ids;
}

}  // namespace gnomon
