// A Vulkan 1.3 device without a window: instance, physical device, one queue, and what it can do.
#pragma once

#include <volk.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/vulkan/device_info.h"

namespace gnomon {

// Throws Error naming the Vulkan call when `result` is not a success.
void check(VkResult result, const char* call);

class PipelineStore;

class Device {
 public:
  explicit Device(const DeviceOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkInstance instance() const { return instance_; }
  VkPhysicalDevice physical() const { return physical_; }
  VkDevice handle() const { return device_; }
  VkQueue queue() const { return queue_; }
  uint32_t queue_family() const { return queue_family_; }
  const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
  uint32_t subgroup_size() const { return subgroup_size_; }  // invocations, at least 4
  const DeviceInfo& info() const { return info_; }
  // Can a vertex shader choose the layer that it draws into? Else layers are drawn one by one.
  bool chooses_layers() const { return chooses_layers_; }
  // Does a fragment shader know its triangle's number?
  bool numbers_triangles() const { return numbers_triangles_; }
  double timestamp_period_ns() const { return properties_.limits.timestampPeriod; }
  PipelineStore& pipelines() { return *pipelines_; }

  // Index of a memory type allowed by `type_bits` with all of `wanted`; Error when there is none.
  uint32_t memory_type(uint32_t type_bits, VkMemoryPropertyFlags wanted) const;
  // Like memory_type, with `preferred` flags too where some type has them.
  uint32_t memory_type(uint32_t type_bits, VkMemoryPropertyFlags wanted,
                       VkMemoryPropertyFlags preferred) const;

  // Messages of the validation layers so far (warnings and errors).
  const std::vector<std::string>& messages() const { return messages_; }
  void add_message(std::string text);

  // Bytes of device memory allocated now and at most so far; kept by the owners of memory.
  void count_memory(int64_t bytes);
  uint64_t peak_bytes() const { return peak_bytes_; }

 private:
  void make_instance(bool validation);
  void choose_physical(const std::string& name_part);
  void make_device(bool thrifty);
  void check_features(bool thrifty);
  void destroy();

  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  // Of this instance: volk's is of the instance made last, which may lack the extension.
  PFN_vkDestroyDebugUtilsMessengerEXT destroy_messenger_ = nullptr;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  uint32_t queue_family_ = 0, subgroup_size_ = 0;
  bool chooses_layers_ = false, numbers_triangles_ = false;
  VkPhysicalDeviceProperties properties_{};
  VkPhysicalDeviceMemoryProperties memory_{};
  DeviceInfo info_;
  std::unique_ptr<PipelineStore> pipelines_;
  std::mutex mutex_;  // the validation layer may call from any thread
  std::vector<std::string> messages_;
  uint64_t bytes_ = 0, peak_bytes_ = 0;
};

}  // namespace gnomon
