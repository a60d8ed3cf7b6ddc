// Runs one graph on one scene, frame by frame, and measures it.
#include "engine/render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "engine/base/error.h"
#include "engine/base/interrupt.h"
#include "engine/light/scene_facts.h"
#include "engine/plan/compile.h"
#include "engine/plan/memory_limit.h"
#include "engine/render/context.h"
#include "engine/render/device_plan.h"
#include "engine/render/environment.h"
#include "engine/render/gpu_scene.h"
#include "engine/scene/camera.h"
#include "engine/scene/wide_spot.h"
#include "engine/vulkan/handle.h"
#include "engine/vulkan/readback.h"
#include "engine/vulkan/timing.h"

namespace gnomon {
namespace {

using Clock = std::chrono::steady_clock;
double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// A wait that never ends is an error, not a hang. Generous: software devices run slow frames.
constexpr uint32_t kMaxSections = 4096;  // in one submission; further ones count to the one before

constexpr uint64_t kFenceTimeoutNs = 600ull * 1000 * 1000 * 1000;

// Stands where there is no scene: nothing to see, for a camera and a light that have no say in the result.
std::shared_ptr<const Scene> no_scene() {
  Scene scene;
  scene.materials.emplace_back();
  scene.cameras.emplace_back();
  scene.lights.emplace_back();
  scene.bounds.add(glm::dvec3(0.0));
  return std::make_shared<const Scene>(std::move(scene));
}

// Of such a scene nothing can be told.
SceneFacts facts_of_nothing() {
  SceneFacts facts;
  facts.lights = 1;
  facts.shadowless = {{}};
  facts.light_moves = {false};
  facts.light_size = {0};
  facts.penumbra = {0};
  return promising_nothing(facts);
}

}  // namespace

// What lies between two stamps: a pass, or a part of one.
struct Part {
  uint32_t node;
  std::string name;  // Context::section; empty: before the first
  double cpu_ms;
};

struct Renderer::Impl {
  Impl(std::shared_ptr<Device> d, std::shared_ptr<const Scene> s, const Graph& graph,
       const RenderSettings& settings);
  ~Impl();

  void prepare();
  FrameTiming render(TimingMode mode);
  void run_segments(uint32_t first, uint32_t last, uint32_t iteration, TimingMode mode, FrameTiming& timing);
  void submit(const Segment& segment, uint32_t iteration, bool repeat, TimingMode mode, FrameTiming& timing);
  std::vector<Part> record(const Segment& segment, uint32_t iteration, bool repeat, TimingMode mode);
  void record_pass(uint32_t node, uint32_t iteration, TimingMode mode, std::vector<Part>& parts);
  void add_timings(const Segment& segment, uint32_t iteration, const std::vector<Part>& parts, double wait_ms,
                   FrameTiming& timing) const;
  void execute(const Segment& segment);
  void run_loop(const LoopPlan& loop, TimingMode mode, FrameTiming& timing);
  HostView host_view(const PlanNode& node, uint32_t iteration) const;
  FrameView view() const { return {settings.camera, settings.width, settings.height, settings.reversed_z}; }
  uint32_t readable(const std::string& output) const;  // index of its resource

  std::shared_ptr<Device> device;
  std::shared_ptr<const Scene> scene;
  RenderSettings settings;
  GpuScene gpu_scene;
  Plan plan;
  std::unique_ptr<DevicePlan> on_device;
  Handle<VkPipelineCache> cache;
  Handle<VkCommandPool> command_pool;
  VkCommandBuffer commands = VK_NULL_HANDLE;  // of the pool
  Handle<VkFence> fence;
  std::unique_ptr<Timestamps> stamps;
  std::map<std::string, double> facts;
  std::vector<std::string> warnings;
  std::vector<LeftOutPass> left_out_parts;
  uint32_t frame = 0;
  double seconds = 0, next_seconds = 0;  // the scene's time of the last frame, and of the next
  bool playing = false;                  // time runs from frame to frame
};

Renderer::Impl::Impl(std::shared_ptr<Device> d, std::shared_ptr<const Scene> s, const Graph& graph,
                     const RenderSettings& r)
    : device(std::move(d)), scene(s ? std::move(s) : no_scene()), settings(r), gpu_scene(device, scene) {
  if (settings.camera >= scene->cameras.size())
    fail(fmt::format("the scene has {} camera(s), number {} is asked for", scene->cameras.size(),
                     settings.camera),
         scene->file.string(), "--camera", "cameras are counted from 0");
  const Camera& camera = scene->cameras[settings.camera];
  if (camera.span) settings.reversed_z = false;
  Declaration::Setting setting{{settings.width, settings.height},
                               uint32_t(scene->lights.size()),
                               settings.memory,
                               {},
                               scene_sizes(*scene)};
  for (const Light& light : scene->lights) setting.light_types.push_back(view_type(light));
  CompileOptions options;
  options.alias = settings.alias;
  options.keep_all = settings.keep_all;
  options.captures = settings.captures;
  options.memory = [this](const Resource& resource) { return device_need(device, resource); };
  const double aspect = double(settings.width) / settings.height;
  if (const std::string warning = aspect_warning(camera, aspect); !warning.empty())
    warnings.push_back(warning);
  const SceneFacts facts_of_view =
      scene->meshes.empty() ? facts_of_nothing() : scene_facts(*scene, camera, aspect, settings.height);
  const SceneFacts allowed = settings.keep_all ? promising_nothing(facts_of_view) : facts_of_view;
  plan = compile(graph, setting, allowed, options);
  check_memory(plan, graph, setting, allowed, options);
  gpu_scene.update(view(), 0, 0);

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
  stamps = std::make_unique<Timestamps>(device, uint32_t(plan.nodes.size()) + 1 + kMaxSections);

  on_device = std::make_unique<DevicePlan>(device, gpu_scene, plan);
  prepare();
}

Renderer::Impl::~Impl() { vkDeviceWaitIdle(device->handle()); }

void Renderer::Impl::prepare() {
  for (uint32_t i = 0; i < plan.nodes.size(); ++i) {
    Environment environment(device, gpu_scene, plan.facts, settings, plan.nodes[i], on_device->node(i),
                            on_device->resources(), cache.get());
    plan.nodes[i].pass->prepare(environment);
    facts.insert(environment.facts().begin(), environment.facts().end());
    warnings.insert(warnings.end(), environment.warnings().begin(), environment.warnings().end());
    left_out_parts.insert(left_out_parts.end(), environment.left_out().begin(), environment.left_out().end());
  }
}

FrameTiming Renderer::Impl::render(TimingMode mode) {
  check_interrupt();
  FrameTiming timing;
  const auto start = Clock::now();
  if (frame > 0) on_device->swap_history();
  if (playing) next_seconds = frame * settings.frame_seconds;
  seconds = next_seconds;
  gpu_scene.update(view(), seconds, frame++);
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
  const auto bytes = [this, &node](std::string_view port) {
    if (!node.resources.contains(std::string(port)))
      fail(fmt::format("pass '{}' has no port '{}'", node.id, port));
    return on_device->physical_at(node, std::string(port)).buffer.bytes();
  };
  return {iteration, bytes, bytes};
}

std::vector<Part> Renderer::Impl::record(const Segment& segment, uint32_t iteration, bool repeat,
                                         TimingMode mode) {
  check(vkResetCommandPool(device->handle(), command_pool.get(), 0), "vkResetCommandPool");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  if (mode != TimingMode::none)
    stamps->reset(commands), stamps->stamp(commands, mode == TimingMode::isolated);
  for (const LoopPlan& loop : plan.loops)
    if (repeat && plan.segments[loop.first_segment].first == segment.first)
      on_device->barriers(commands, loop.repeat_barriers);
  std::vector<Part> parts;
  for (uint32_t i = segment.first; i < segment.last; ++i) record_pass(i, iteration, mode, parts);
  on_device->barriers(commands, segment.end_barriers);
  if (segment.last == plan.nodes.size()) on_device->barriers(commands, plan.final_barriers);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  return parts;
}

void Renderer::Impl::record_pass(uint32_t node, uint32_t iteration, TimingMode mode,
                                 std::vector<Part>& parts) {
  auto start = Clock::now();
  std::string part;
  const auto finish = [&] {
    if (mode != TimingMode::none) stamps->stamp(commands, mode == TimingMode::isolated);
    parts.push_back({node, part, ms_since(start)});
    start = Clock::now();
  };
  const auto section = [&](std::string_view name) {
    const bool room = parts.size() + plan.nodes.size() < kMaxSections;
    if (name == part || !room) return;
    finish();
    part = name;
  };
  on_device->barriers(commands, plan.nodes[node].barriers, iteration == 0);
  Context context(commands, gpu_scene, plan.nodes[node], on_device->node(node), on_device->resources(),
                  on_device->previous(), iteration, section);
  plan.nodes[node].pass->record(context);
  finish();
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
  const auto record_start = Clock::now();
  const std::vector<Part> parts = record(segment, iteration, repeat, mode);
  timing.record_ms += ms_since(record_start);
  const auto wait_start = Clock::now();
  execute(segment);
  if (mode != TimingMode::none) add_timings(segment, iteration, parts, ms_since(wait_start), timing);
}

void Renderer::Impl::add_timings(const Segment& segment, uint32_t iteration, const std::vector<Part>& parts,
                                 double wait_ms, FrameTiming& timing) const {
  const auto at = stamps->read();
  timing.gpu_ms += at.back() - at.front();
  const size_t first = timing.passes.size();
  for (size_t k = 0; k < parts.size(); ++k) {
    const PlanNode& node = plan.nodes[parts[k].node];
    const std::string id = parts[k].name.empty() ? node.id : node.id + "." + parts[k].name;
    const auto known = std::find_if(timing.passes.begin() + ptrdiff_t(first), timing.passes.end(),
                                    [&](const PassTiming& pass) { return pass.id == id; });
    PassTiming& pass = known != timing.passes.end() ? *known : timing.passes.emplace_back();
    pass.id = id, pass.type = node.type, pass.iteration = iteration;
    pass.gpu_ms += at[k + 1] - at[k];
    pass.cpu_ms += parts[k].cpu_ms;
  }
  if (segment.host_wait) timing.passes.back().host_wait_ms = wait_ms;
}

Renderer::Renderer(std::shared_ptr<Device> device, std::shared_ptr<const Scene> scene, const Graph& graph,
                   const RenderSettings& settings)
    : impl_(std::make_unique<Impl>(std::move(device), std::move(scene), graph, settings)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

FrameTiming Renderer::render(TimingMode mode) { return impl_->render(mode); }

void Renderer::seek(double seconds) {
  impl_->next_seconds = seconds;
  impl_->playing = false;
}
void Renderer::play() {
  impl_->on_device->forget();
  impl_->frame = 0;
  impl_->playing = true;
}
double Renderer::seconds() const { return impl_->seconds; }

uint32_t Renderer::Impl::readable(const std::string& output) const {
  auto found = plan.outputs.find(output);
  if (found == plan.outputs.end()) {
    found = plan.captures.find(output);
    if (found == plan.captures.end()) fail(fmt::format("no output or captured port '{}'", output));
  }
  if (plan.resources[found->second].is_buffer)
    fail(fmt::format("'{}' is a buffer: only images can be captured", output));
  return found->second;
}

Image Renderer::read(const std::string& output) {
  const uint32_t index = impl_->readable(output);
  const Resource& resource = impl_->plan.resources[index];
  const Extent shown =
      resource.constant ? Extent{impl_->settings.width, impl_->settings.height} : resource.image.extent;
  return read_back(impl_->device, impl_->on_device->resources()[index].image, shown);
}

std::vector<uint32_t> Renderer::read_words(const std::string& output) {
  return read_back_words(impl_->device, impl_->on_device->resources()[impl_->readable(output)].image);
}

std::optional<Renderer::MapViews> Renderer::map_views(const std::string& port) const {
  const uint32_t resource = impl_->readable(port);
  for (const PlanNode& node : impl_->plan.nodes)
    for (const Port& made : node.declaration.ports()) {
      const auto own = node.resources.find(made.name);
      if (made.behind.empty() || own == node.resources.end() || own->second != resource) continue;
      if (made.direction != Direction::out && made.direction != Direction::inout) continue;
      for (const auto& [name, index] : node.resources) {
        const std::shared_ptr<ViewSet>& set = impl_->on_device->resources()[index].views;
        if (set && set->views.size() == made.image.layers) return MapViews{set->views, made.traits};
      }
    }
  return std::nullopt;
}

MemoryUse Renderer::memory() const {
  return {impl_->device->peak_bytes(), impl_->plan.heap_bytes, impl_->plan.heap_bytes_without_aliasing};
}
std::vector<LeftOutPass> Renderer::left_out() const {
  std::vector<LeftOutPass> result;
  for (const LeftOut& l : impl_->plan.left_out) result.push_back({l.id, {}, l.reason});
  result.insert(result.end(), impl_->left_out_parts.begin(), impl_->left_out_parts.end());
  return result;
}
std::vector<std::string> Renderer::warnings() const { return impl_->warnings; }
std::map<std::string, double> Renderer::facts() const {
  std::map<std::string, double> all = impl_->facts;
  for (const PlanNode& node : impl_->plan.nodes)
    for (const auto& [name, value] : node.pass->figures()) all[node.id + "." + name] = value;
  return all;
}
const Plan& Renderer::plan() const { return impl_->plan; }
std::vector<std::string> Renderer::passes() const {
  std::vector<std::string> ids;
  for (const PlanNode& node : impl_->plan.nodes) ids.push_back(node.id);
  return ids;
}

}  // namespace gnomon
