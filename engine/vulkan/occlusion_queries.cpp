// Occlusion queries, written in one submission and read at once.
#include "engine/vulkan/occlusion_queries.h"

#include "engine/base/error.h"

namespace gnomon {

OcclusionQueries::OcclusionQueries(const std::shared_ptr<Device>& device, uint32_t count) : count_(count) {
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_OCCLUSION;
  info.queryCount = count;
  pool_ = create(device, vkCreateQueryPool, info, vkDestroyQueryPool, "vkCreateQueryPool");
}

}  // namespace gnomon
