// A plan on a device: its resources and memory, and every node's layouts and descriptor sets.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/light/view_set.h"
#include "engine/plan/compile.h"
#include "engine/render/gpu_scene.h"
#include "engine/vulkan/handle.h"

namespace gnomon {

// A resource of the plan on the device.
struct Physical {
  GpuImage image;
  Buffer buffer;
  std::shared_ptr<ViewSet> views;  // of a buffer of light views: what the host knows of them
};

// That of a node's port among `resources` (Plan's order). Error: no such port.
const Physical& physical_of(const PlanNode& node, const std::vector<Physical>& resources,
                            const std::string& port);

// The light views that the host knows of in a node's port. Error: none.
const ViewSet& views_of(const PlanNode& node, const std::vector<Physical>& resources,
                        const std::string& port);

// One node's own state on the device: layouts, descriptor set and parameter block.
struct NodeState {
  Handle<VkDescriptorSetLayout> set_layout;
  Handle<VkPipelineLayout> pipeline_layout;
  VkDescriptorSet set = VK_NULL_HANDLE;
  VkDescriptorSet other_set = VK_NULL_HANDLE;  // with the copies of history exchanged; swapped every frame
  Buffer parameters;
  std::string preamble;
  bool layers_at_once = true;  // Device::chooses_layers()
};

// Memory that a resource takes on this device (CompileOptions::memory).
MemoryNeed device_need(const std::shared_ptr<Device>& device, const Resource& resource);

class DevicePlan {
 public:
  // `scene` and `plan` outlive it. Folded constants are filled; both copies of history are zero.
  DevicePlan(std::shared_ptr<Device> device, const GpuScene& scene, const Plan& plan);

  const std::vector<Physical>& resources() const { return resources_; }
  // A history resource's copy of the frame before; empty for others.
  const std::vector<Physical>& previous() const { return previous_; }
  const NodeState& node(uint32_t index) const { return nodes_[index]; }
  // What a node's port is: for a history input the copy of the frame before.
  const Physical& physical_at(const PlanNode& node, const std::string& port) const;

  void swap_history();  // between frames
  void forget();        // history is zero again, as before the first frame; between frames
  // Records the barriers; those marked once only in a loop's first iteration.
  void barriers(VkCommandBuffer commands, const std::vector<Barrier>& list, bool first_turn = true) const;

 private:
  void make_resources();
  void make_nodes();
  void make_node(uint32_t index);
  void write_set(const PlanNode& node, NodeState& state);
  void fill_initial();

  std::shared_ptr<Device> device_;
  const GpuScene& scene_;
  const Plan& plan_;
  Memory heap_;
  std::vector<Physical> resources_, previous_;  // after the heap, so destroyed first
  bool has_history_ = false;
  std::vector<NodeState> nodes_;
  Handle<VkDescriptorPool> pool_;
  Handle<VkSampler> sampler_;
};

}  // namespace gnomon
