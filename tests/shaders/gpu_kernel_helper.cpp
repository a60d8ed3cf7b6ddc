// Runs small compute shaders, so that the shader libraries can be tested function by function.
#include "tests/shaders/gpu_kernel_helper.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "engine/vulkan/resources.h"

namespace gnomon::test {
namespace {

namespace fs = std::filesystem;

// Torn down by GoogleTest before static destructors run: the Vulkan layers have state of their own.
class Shared : public ::testing::Environment {
 public:
  std::shared_ptr<Device> device;
  fs::path folder;
  void TearDown() override {
    device.reset();
    std::error_code ignored;
    if (!folder.empty()) fs::remove_all(folder, ignored);
  }
};

Shared& shared() {
  static Shared* environment = [] {
    auto* made = new Shared;  // GoogleTest owns it
    ::testing::AddGlobalTestEnvironment(made);
    return made;
  }();
  return *environment;
}

[[maybe_unused]] const bool registered = (shared(), true);

fs::path write_shader(const std::string& name, const std::string& glsl) {
  const fs::path file = scratch_folder() / (name + ".glsl");
  std::ofstream(file) << glsl;
  return file;
}

void expect_no_messages(const Device& device, size_t before) {
  for (size_t i = before; i < device.messages().size(); ++i) ADD_FAILURE() << device.messages()[i];
}

}  // namespace

std::shared_ptr<Device> kernel_device() {
  const char* name = std::getenv("GNOMON_TEST_DEVICE");
  if (!shared().device)
    shared().device = std::make_shared<Device>(
        DeviceOptions{.name_part = name != nullptr ? name : "llvmpipe", .validation = true});
  return shared().device;
}

fs::path scratch_folder() {
  if (shared().folder.empty()) {
    shared().folder = fs::path(::testing::TempDir()) / ("gnomon-test-" + std::to_string(getpid()));
    fs::remove_all(shared().folder);
    fs::create_directories(shared().folder);
  }
  return shared().folder;
}

Kernel::Kernel(const std::string& name, const std::string& glsl, uint32_t buffers)
    : device_(kernel_device()), buffers_(buffers) {
  make_layouts();
  pipeline_ = make_compute_pipeline(device_, layout_,
                                    {write_shader(name, glsl), ShaderStage::compute, {}, {}}, VK_NULL_HANDLE);
}

Kernel::~Kernel() {
  pipeline_ = {};
  vkDestroyDescriptorPool(device_->handle(), pool_, nullptr);
  vkDestroyPipelineLayout(device_->handle(), layout_, nullptr);
  vkDestroyDescriptorSetLayout(device_->handle(), set_layout_, nullptr);
}

void Kernel::make_layouts() {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (uint32_t i = 0; i < buffers_; ++i)
    bindings.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.bindingCount = buffers_;
  set.pBindings = bindings.data();
  check(vkCreateDescriptorSetLayout(device_->handle(), &set, nullptr, &set_layout_),
        "vkCreateDescriptorSetLayout");
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &set_layout_;
  check(vkCreatePipelineLayout(device_->handle(), &layout, nullptr, &layout_), "vkCreatePipelineLayout");
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, buffers_};
  VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool.maxSets = 1;
  pool.poolSizeCount = 1;
  pool.pPoolSizes = &size;
  check(vkCreateDescriptorPool(device_->handle(), &pool, nullptr, &pool_), "vkCreateDescriptorPool");
}

VkDescriptorSet Kernel::write_set(std::span<const VkDescriptorBufferInfo> buffers) const {
  check(vkResetDescriptorPool(device_->handle(), pool_, 0), "vkResetDescriptorPool");
  VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  info.descriptorPool = pool_;
  info.descriptorSetCount = 1;
  info.pSetLayouts = &set_layout_;
  VkDescriptorSet set = VK_NULL_HANDLE;
  check(vkAllocateDescriptorSets(device_->handle(), &info, &set), "vkAllocateDescriptorSets");
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = set;
  write.descriptorCount = uint32_t(buffers.size());
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  write.pBufferInfo = buffers.data();
  vkUpdateDescriptorSets(device_->handle(), 1, &write, 0, nullptr);
  return set;
}

std::vector<std::byte> Kernel::run(std::initializer_list<std::span<const std::byte>> inputs,
                                   size_t output_bytes, size_t invocations) const {
  const size_t messages = device_->messages().size();
  if (inputs.size() + 1 != buffers_) throw std::logic_error("a kernel is run with a wrong number of inputs");
  std::vector<Buffer> buffers;
  std::vector<VkDescriptorBufferInfo> infos;
  const auto add = [&](size_t size) {
    buffers.emplace_back(device_, std::max<size_t>(size, 4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Place::host);
    infos.push_back({buffers.back().handle(), 0, VK_WHOLE_SIZE});
  };
  for (const auto& input : inputs) {
    add(input.size());
    std::copy(input.begin(), input.end(), buffers.back().bytes().begin());
  }
  add(output_bytes);
  std::ranges::fill(buffers.back().bytes(), std::byte{0});

  const VkDescriptorSet set = write_set(infos);
  OneShot once(device_);
  vkCmdBindPipeline(once.commands(), VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.handle);
  vkCmdBindDescriptorSets(once.commands(), VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set, 0, nullptr);
  vkCmdDispatch(once.commands(), uint32_t((invocations + 63) / 64), 1, 1);
  VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_SHADER_WRITE_BIT,
                          VK_ACCESS_HOST_READ_BIT};
  vkCmdPipelineBarrier(once.commands(), VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0,
                       1, &barrier, 0, nullptr, 0, nullptr);
  once.submit_and_wait();
  expect_no_messages(*device_, messages);
  const auto out = buffers.back().bytes().first(output_bytes);
  return {out.begin(), out.end()};
}

}  // namespace gnomon::test
