// Ownership of a Vulkan object without memory of its own.
#pragma once

#include <memory>
#include <utility>

#include "engine/vulkan/device.h"

namespace gnomon {

// Destroys the object with the function given when it goes out of scope. Move-only.
template <class T>
class Handle {
 public:
  using Destroy = void(VKAPI_PTR*)(VkDevice, T, const VkAllocationCallbacks*);
  Handle() = default;
  Handle(std::shared_ptr<Device> device, T object, Destroy destroy)
      : device_(std::move(device)), object_(object), destroy_(destroy) {}
  ~Handle() {
    if (object_) destroy_(device_->handle(), object_, nullptr);
  }
  Handle(Handle&& other) noexcept { swap(other); }
  Handle& operator=(Handle&& other) noexcept {
    swap(other);
    return *this;
  }
  T get() const { return object_; }
  explicit operator bool() const { return object_ != VK_NULL_HANDLE; }

 private:
  void swap(Handle& o) {
    std::swap(device_, o.device_), std::swap(object_, o.object_), std::swap(destroy_, o.destroy_);
  }
  std::shared_ptr<Device> device_;
  T object_ = VK_NULL_HANDLE;
  Destroy destroy_ = nullptr;
};

// Calls a vkCreate function and owns what it made; Error naming `call` otherwise.
template <class T, class Info>
Handle<T> create(const std::shared_ptr<Device>& device,
                 VkResult(VKAPI_PTR* make)(VkDevice, const Info*, const VkAllocationCallbacks*, T*),
                 const Info& info, typename Handle<T>::Destroy destroy, const char* call) {
  T object = VK_NULL_HANDLE;
  check(make(device->handle(), &info, nullptr, &object), call);
  return Handle<T>(device, object, destroy);
}

}  // namespace gnomon
