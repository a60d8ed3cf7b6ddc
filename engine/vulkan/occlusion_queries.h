// Occlusion queries: did any sample of some draws pass?
#pragma once

#include <memory>

#include "engine/vulkan/handle.h"

namespace gnomon {

class OcclusionQueries {
 public:
  OcclusionQueries() = default;
  OcclusionQueries(const std::shared_ptr<Device>& device, uint32_t count);
  VkQueryPool pool() const { return pool_.get(); }
  uint32_t count() const { return count_; }

 private:
  Handle<VkQueryPool> pool_;
  uint32_t count_ = 0;
};

}  // namespace gnomon
