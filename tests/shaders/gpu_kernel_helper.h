// Runs small compute shaders on lavapipe, so that the shader libraries can be tested function by function.
#pragma once

#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/vulkan/device.h"
#include "engine/vulkan/pipeline.h"

namespace gnomon::test {

// Lavapipe, or the device that GNOMON_TEST_DEVICE names, with the validation layers on: one for the test
// program, opened on first use.
std::shared_ptr<Device> kernel_device();

// A folder of this process alone, empty when first asked for, removed at the end of the program.
std::filesystem::path scratch_folder();

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

class Kernel {
 public:
  // `glsl`: a whole compute shader without #version, local size 64; storage buffers are bindings 0.. of set
  // 0, the output being the last. Includes resolve against shaders/glsl. Error: what the compiler says.
  Kernel(const std::string& name, const std::string& glsl, uint32_t buffers);
  ~Kernel();
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  // Content of the output buffer, zero before. Fails the current test when the validation layers say
  // anything.
  std::vector<std::byte> run(std::initializer_list<std::span<const std::byte>> inputs, size_t output_bytes,
                             size_t invocations) const;

  template <class T>
  std::vector<T> run(std::initializer_list<std::span<const std::byte>> inputs, size_t count) const {
    const auto bytes = run(inputs, count * sizeof(T), count);
    std::vector<T> values(count);
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

 private:
  void make_layouts();
  VkDescriptorSet write_set(std::span<const VkDescriptorBufferInfo> buffers) const;

  std::shared_ptr<Device> device_;
  uint32_t buffers_ = 0;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  Pipeline pipeline_;
};

}  // namespace gnomon::test
