// Timestamps at pass boundaries.
#include "engine/vulkan/timing.h"

#include "engine/base/error.h"
#include "engine/vulkan/commands.h"

namespace gnomon {

Timestamps::Timestamps(std::shared_ptr<Device> device, uint32_t capacity)
    : device_(std::move(device)), capacity_(capacity) {
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = capacity;
  pool_ = create(device_, vkCreateQueryPool, info, vkDestroyQueryPool, "vkCreateQueryPool");
}

void Timestamps::reset(VkCommandBuffer commands) {
  vkCmdResetQueryPool(commands, pool_.get(), 0, capacity_);
  used_ = 0;
}

void Timestamps::stamp(VkCommandBuffer commands, bool alone) {
  if (alone) full_barrier(commands);
  vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_.get(), used_++);
}

std::vector<double> Timestamps::read() const {
  std::vector<uint64_t> ticks(used_);
  if (used_ == 0) return {};
  check(vkGetQueryPoolResults(device_->handle(), pool_.get(), 0, used_, ticks.size() * 8, ticks.data(), 8,
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "vkGetQueryPoolResults");
  std::vector<double> ms;
  for (uint64_t t : ticks) ms.push_back(double(t - ticks[0]) * device_->timestamp_period_ns() * 1e-6);
  return ms;
}

}  // namespace gnomon
