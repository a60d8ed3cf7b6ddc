// Buffers, images and memory, each owned by one C++ object.
#pragma once

#include <memory>
#include <span>

#include "engine/base/shape.h"
#include "engine/vulkan/device.h"

namespace gnomon {

class Memory {  // one device allocation
 public:
  Memory() = default;
  Memory(std::shared_ptr<Device> device, uint64_t size, uint32_t type);
  ~Memory();
  Memory(Memory&& other) noexcept { swap(other); }
  Memory& operator=(Memory&& other) noexcept {
    swap(other);
    return *this;
  }
  VkDeviceMemory handle() const { return handle_; }
  uint64_t size() const { return size_; }
  void* map();  // of host-visible memory; stays mapped

 private:
  void swap(Memory& o) {
    std::swap(device_, o.device_), std::swap(handle_, o.handle_), std::swap(size_, o.size_);
  }
  std::shared_ptr<Device> device_;
  VkDeviceMemory handle_ = VK_NULL_HANDLE;
  uint64_t size_ = 0;
};

enum class Place { device, host };  // host: mapped for writing or reading by the CPU

class Buffer {
 public:
  Buffer() = default;
  // With memory of its own; without any when `allocate` is false (see bind).
  Buffer(std::shared_ptr<Device> device, uint64_t size, VkBufferUsageFlags usage, Place place,
         bool allocate = true);
  ~Buffer();
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }
  VkBuffer handle() const { return handle_; }
  uint64_t size() const { return size_; }
  std::span<std::byte> bytes() const { return {static_cast<std::byte*>(mapped_), mapped_ ? size_ : 0}; }
  VkMemoryRequirements requirements() const;
  void bind(VkDeviceMemory memory, uint64_t offset);
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

 private:
  void swap(Buffer& o);
  std::shared_ptr<Device> device_;
  VkBuffer handle_ = VK_NULL_HANDLE;
  uint64_t size_ = 0;
  Memory memory_;
  void* mapped_ = nullptr;
};

class GpuImage {
 public:
  GpuImage() = default;
  GpuImage(std::shared_ptr<Device> device, const ImageShape& shape, VkImageUsageFlags usage,
           bool allocate = true);
  ~GpuImage();
  GpuImage(GpuImage&& other) noexcept { swap(other); }
  GpuImage& operator=(GpuImage&& other) noexcept {
    swap(other);
    return *this;
  }
  VkImage handle() const { return handle_; }
  const ImageShape& shape() const { return shape_; }
  VkImageAspectFlags aspect() const;
  VkMemoryRequirements requirements() const;
  void bind(VkDeviceMemory memory, uint64_t offset);
  // Views are made on first use and live as long as the image. Depth-and-stencil images: `aspect` of the
  // view.
  VkImageView view(VkImageViewType type, uint32_t first_layer, uint32_t layers, uint32_t first_mip,
                   uint32_t mips, VkImageAspectFlags aspect) const;
  VkImageView sampled_view(bool array) const;  // depth aspect of depth formats; all mips
  VkImageView storage_view(bool array) const;  // mip 0
  VkImageView attachment_view() const;         // all layers, mip 0, all aspects
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

 private:
  struct View {
    VkImageViewType type;
    uint32_t layer, layers, mip, mips;
    VkImageAspectFlags aspect;
    VkImageView handle;
  };
  void swap(GpuImage& o);
  std::shared_ptr<Device> device_;
  VkImage handle_ = VK_NULL_HANDLE;
  ImageShape shape_;
  Memory memory_;
  mutable std::vector<View> views_;
};

// Commands for set-up and reading back: recorded, submitted and waited for at once.
class OneShot {
 public:
  explicit OneShot(std::shared_ptr<Device> device);
  ~OneShot();
  VkCommandBuffer commands() const { return commands_; }
  void submit_and_wait();

 private:
  std::shared_ptr<Device> device_;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

// A device buffer with this content.
Buffer upload_buffer(const std::shared_ptr<Device>& device, std::span<const std::byte> bytes,
                     VkBufferUsageFlags usage);

VkImageAspectFlags aspect_of(VkFormat format);

}  // namespace gnomon
