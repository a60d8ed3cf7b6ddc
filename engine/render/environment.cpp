// What a pass is given to make its pipelines and buffers.
#include "engine/render/environment.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/format.h"
#include "engine/light/view_set.h"
#include "engine/plan/compile.h"
#include "engine/render/device_plan.h"
#include "engine/render/gpu_scene.h"
#include "engine/render/preamble.h"
#include "engine/render/render_settings.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/occlusion_queries.h"

namespace gnomon {

Environment::Environment(std::shared_ptr<Device> device, const GpuScene& scene, const SceneFacts& scene_facts,
                         const RenderSettings& settings, const PlanNode& node, const NodeState& state,
                         const std::vector<Physical>& resources, VkPipelineCache cache)
    : device_(std::move(device)),
      scene_(scene),
      scene_facts_(scene_facts),
      settings_(settings),
      node_(node),
      state_(state),
      resources_(resources),
      cache_(cache) {}

const Scene& Environment::scene() const { return scene_.scene(); }
const std::string& Environment::id() const { return node_.id; }
const Params& Environment::params() const { return node_.params; }

ImageShape Environment::shape(const std::string& port) const {
  return physical_of(node_, resources_, port).image.shape();
}

bool Environment::connected(const std::string& port) const { return node_.resources.contains(port); }

std::optional<uint32_t> Environment::reach(const std::string& output) const {
  const auto found = node_.reach.find(output);
  if (found == node_.reach.end()) fail(fmt::format("pass '{}' has no output '{}'", node_.id, output));
  return found->second;
}

const ViewSet& Environment::views(const std::string& port) const { return views_of(node_, resources_, port); }
void Environment::publish(const std::string& port, ViewSet views) const {
  *physical_of(node_, resources_, port).views = std::move(views);
}

Defines Environment::with_parameters(Defines defines) const {
  for (auto& d : parameter_defines(node_.params)) defines.push_back(std::move(d));
  defines.emplace_back("KEEP_ALL", settings_.keep_all ? "1" : "0");
  return defines;
}

Pipeline Environment::compute(const std::string& file, Defines defines) const {
  return make_compute_pipeline(
      device_, state_.pipeline_layout.get(),
      {file, ShaderStage::compute, state_.preamble, with_parameters(std::move(defines))}, cache_);
}

Pipeline Environment::raster(RasterState state) const {
  state.defines = with_parameters(std::move(state.defines));
  return make_raster_pipeline(device_, state_.pipeline_layout.get(), state, state_.preamble, cache_);
}

Buffer Environment::upload(std::span<const std::byte> bytes, VkBufferUsageFlags usage) const {
  return upload_buffer(device_, bytes, usage);
}

void Environment::write(const std::string& port, std::span<const std::byte> bytes) const {
  if (bytes.empty()) return;
  const Buffer& to = physical_of(node_, resources_, port).buffer;
  if (bytes.size() > to.size())
    fail(fmt::format("pass '{}' has {} bytes for '{}', which holds {}", node_.id, bytes.size(), port,
                     to.size()));
  const Buffer staging(device_, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Place::host);
  std::copy(bytes.begin(), bytes.end(), staging.bytes().begin());
  OneShot once(device_);
  const VkBufferCopy region{0, 0, bytes.size()};
  vkCmdCopyBuffer(once.commands(), staging.handle(), to.handle(), 1, &region);
  full_barrier(once.commands());
  once.submit_and_wait();
}

void Environment::check_mips(const std::string& port) const {
  const VkFormat format = shape(port).format;
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(device_->physical(), format, &properties);
  constexpr VkFormatFeatureFlags kNeeded = VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT |
                                           VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
  if ((properties.optimalTilingFeatures & kNeeded) == kNeeded) return;
  fail(fmt::format("pass '{}' needs mip levels of '{}', and this device cannot filter {}", node_.id, port,
                   format_name(format)),
       {}, {}, "do without mip levels, or use another number format");
}

OcclusionQueries Environment::occlusion_queries(uint32_t count) const { return {device_, count}; }

void Environment::fact(const std::string& name, double value) { facts_[node_.id + "." + name] = value; }

void Environment::left_out(std::string part, std::string reason) {
  left_out_.push_back({node_.id, std::move(part), std::move(reason)});
}

void Environment::warn(std::string sentence) { warnings_.push_back(node_.id + ": " + std::move(sentence)); }

}  // namespace gnomon
