// Timestamps at pass boundaries.
#pragma once

#include <memory>
#include <vector>

#include "engine/vulkan/handle.h"

namespace gnomon {

class Timestamps {
 public:
  Timestamps(std::shared_ptr<Device> device, uint32_t capacity);

  void reset(VkCommandBuffer commands);
  // After everything recorded so far is done. `alone`: nothing later starts before it either.
  void stamp(VkCommandBuffer commands, bool alone);
  // Milliseconds of each stamp since the first one; the submission must be complete.
  std::vector<double> read() const;

 private:
  std::shared_ptr<Device> device_;
  Handle<VkQueryPool> pool_;
  uint32_t capacity_ = 0, used_ = 0;
};

}  // namespace gnomon
