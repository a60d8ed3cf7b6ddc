// Buffers, images and their memory.
#include "engine/vulkan/resources.h"

#include <fmt/format.h>

#include <cstring>

#include "engine/base/error.h"
#include "engine/base/format.h"

namespace gnomon {

Memory::Memory(std::shared_ptr<Device> device, uint64_t size, uint32_t type)
    : device_(std::move(device)), size_(size) {
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, size, type};
  if (vkAllocateMemory(device_->handle(), &info, nullptr, &handle_) != VK_SUCCESS)
    fail(fmt::format("out of device memory: {:.1f} MiB asked for", double(size) / (1 << 20)), {}, {},
         "use a smaller --size or shadow map");
  device_->count_memory(int64_t(size));
}
Memory::~Memory() {
  if (!handle_) return;
  vkFreeMemory(device_->handle(), handle_, nullptr);
  device_->count_memory(-int64_t(size_));
}
void* Memory::map() {
  void* data = nullptr;
  check(vkMapMemory(device_->handle(), handle_, 0, VK_WHOLE_SIZE, 0, &data), "vkMapMemory");
  return data;
}

Buffer::Buffer(std::shared_ptr<Device> device, uint64_t size, VkBufferUsageFlags usage, Place place,
               bool allocate)
    : device_(std::move(device)), size_(size) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = size;
  info.usage = usage;
  check(vkCreateBuffer(device_->handle(), &info, nullptr, &handle_), "vkCreateBuffer");
  if (!allocate) return;
  const auto need = requirements();
  constexpr VkMemoryPropertyFlags kHost =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  const uint32_t type =
      place == Place::host
          ? device_->memory_type(need.memoryTypeBits, kHost, VK_MEMORY_PROPERTY_HOST_CACHED_BIT)
          : device_->memory_type(need.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  memory_ = Memory(device_, need.size, type);
  bind(memory_.handle(), 0);
  if (place == Place::host) mapped_ = memory_.map();
}
Buffer::~Buffer() {
  if (handle_) vkDestroyBuffer(device_->handle(), handle_, nullptr);
}
VkMemoryRequirements Buffer::requirements() const {
  VkMemoryRequirements need;
  vkGetBufferMemoryRequirements(device_->handle(), handle_, &need);
  return need;
}
void Buffer::bind(VkDeviceMemory memory, uint64_t offset) {
  check(vkBindBufferMemory(device_->handle(), handle_, memory, offset), "vkBindBufferMemory");
}
void Buffer::swap(Buffer& o) {
  std::swap(device_, o.device_), std::swap(handle_, o.handle_), std::swap(size_, o.size_);
  std::swap(memory_, o.memory_), std::swap(mapped_, o.mapped_);
}

GpuImage::GpuImage(std::shared_ptr<Device> device, const ImageShape& shape, VkImageUsageFlags usage,
                   bool allocate)
    : device_(std::move(device)), shape_(shape) {
  const auto& limits = device_->limits();
  const uint32_t most = limits.maxImageDimension2D;
  if (shape.extent.width == 0 || shape.extent.height == 0 || shape.extent.width > most ||
      shape.extent.height > most)
    fail(fmt::format("an image of {}x{} is beyond this device", shape.extent.width, shape.extent.height), {},
         {}, fmt::format("'{}' allows 1 to {} a side", device_->info().name, most));
  if (shape.layers > limits.maxImageArrayLayers)
    fail(fmt::format("an image of {} layers is beyond this device's {}", shape.layers,
                     limits.maxImageArrayLayers));
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.flags = allocate ? 0 : VK_IMAGE_CREATE_ALIAS_BIT;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = shape.format;
  info.extent = {shape.extent.width, shape.extent.height, 1};
  info.mipLevels = shape.mips;
  info.arrayLayers = shape.layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage;
  check(vkCreateImage(device_->handle(), &info, nullptr, &handle_), "vkCreateImage");
  if (!allocate) return;
  const auto need = requirements();
  memory_ = Memory(device_, need.size,
                   device_->memory_type(need.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT));
  bind(memory_.handle(), 0);
}
GpuImage::~GpuImage() {
  for (const View& v : views_) vkDestroyImageView(device_->handle(), v.handle, nullptr);
  if (handle_) vkDestroyImage(device_->handle(), handle_, nullptr);
}
VkImageAspectFlags GpuImage::aspect() const { return aspect_of(shape_.format); }
VkMemoryRequirements GpuImage::requirements() const {
  VkMemoryRequirements need;
  vkGetImageMemoryRequirements(device_->handle(), handle_, &need);
  return need;
}
void GpuImage::bind(VkDeviceMemory memory, uint64_t offset) {
  check(vkBindImageMemory(device_->handle(), handle_, memory, offset), "vkBindImageMemory");
}
VkImageView GpuImage::view(VkImageViewType type, uint32_t first_layer, uint32_t layers, uint32_t first_mip,
                           uint32_t mips, VkImageAspectFlags aspect) const {
  for (const View& v : views_)
    if (v.type == type && v.layer == first_layer && v.layers == layers && v.mip == first_mip &&
        v.mips == mips && v.aspect == aspect)
      return v.handle;
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = handle_;
  info.viewType = type;
  info.format = shape_.format;
  info.subresourceRange = {aspect, first_mip, mips, first_layer, layers};
  VkImageView handle = VK_NULL_HANDLE;
  check(vkCreateImageView(device_->handle(), &info, nullptr, &handle), "vkCreateImageView");
  views_.push_back({type, first_layer, layers, first_mip, mips, aspect, handle});
  return handle;
}
VkImageView GpuImage::sampled_view(bool array) const {
  const VkImageAspectFlags one =
      is_depth(shape_.format) ? VkImageAspectFlags(VK_IMAGE_ASPECT_DEPTH_BIT) : aspect();
  return view(array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D, 0, array ? shape_.layers : 1, 0,
              shape_.mips, one);
}
VkImageView GpuImage::storage_view(bool array) const {
  return view(array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D, 0, array ? shape_.layers : 1, 0, 1,
              aspect());
}
VkImageView GpuImage::attachment_view() const {
  return view(VK_IMAGE_VIEW_TYPE_2D_ARRAY, 0, shape_.layers, 0, 1, aspect());
}
void GpuImage::swap(GpuImage& o) {
  std::swap(device_, o.device_), std::swap(handle_, o.handle_), std::swap(shape_, o.shape_);
  std::swap(memory_, o.memory_), std::swap(views_, o.views_);
}

OneShot::OneShot(std::shared_ptr<Device> device) : device_(std::move(device)) {
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.queueFamilyIndex = device_->queue_family();
  check(vkCreateCommandPool(device_->handle(), &pool, nullptr, &pool_), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool_,
                                   VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  check(vkAllocateCommandBuffers(device_->handle(), &info, &commands_), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
}
OneShot::~OneShot() { vkDestroyCommandPool(device_->handle(), pool_, nullptr); }
void OneShot::submit_and_wait() {
  check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands_;
  check(vkQueueSubmit(device_->queue(), 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  check(vkQueueWaitIdle(device_->queue()), "vkQueueWaitIdle");
}

Buffer upload_buffer(const std::shared_ptr<Device>& device, std::span<const std::byte> bytes,
                     VkBufferUsageFlags usage) {
  const uint64_t size = std::max<uint64_t>(bytes.size(), 16);  // Vulkan has no empty buffers
  Buffer staging(device, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Place::host);
  if (!bytes.empty()) std::memcpy(staging.bytes().data(), bytes.data(), bytes.size());
  Buffer result(device, size, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, Place::device);
  OneShot once(device);
  VkBufferCopy copy{0, 0, size};
  vkCmdCopyBuffer(once.commands(), staging.handle(), result.handle(), 1, &copy);
  once.submit_and_wait();
  return result;
}

VkImageAspectFlags aspect_of(VkFormat format) {
  switch (format) {
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_D16_UNORM:
      return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
      return VK_IMAGE_ASPECT_COLOR_BIT;
  }
}

}  // namespace gnomon
