// The scene on the device: geometry, materials, and the per-frame data that every shader sees (set 0).
#pragma once

#include <memory>
#include <vector>

#include "engine/render/frame_data.h"
#include "engine/render/raster.h"
#include "engine/scene/scene.h"
#include "engine/vulkan/handle.h"
#include "engine/vulkan/resources.h"
#include "engine/vulkan/vertex.h"

namespace gnomon {

struct Pose;  // engine/scene/animation.h

struct FrameView {                 // what a frame shows
  uint32_t camera = 0;             // index into Scene::cameras
  uint32_t width = 1, height = 1;  // pixels
  bool reversed_z = true;
};

class GpuScene {
 public:
  // A scene with an animation is copied: its meshes take memory twice.
  GpuScene(std::shared_ptr<Device> device, std::shared_ptr<const Scene> scene);
  GpuScene(const GpuScene&) = delete;
  GpuScene& operator=(const GpuScene&) = delete;

  const Scene& scene() const { return *scene_; }  // as update() has posed it
  const std::vector<Draw>& draws() const { return draws_; }
  const FrameData& frame() const { return frame_; }
  const Camera& camera() const { return scene_->cameras[view_.camera]; }  // of the frame

  VkDescriptorSetLayout frame_layout() const { return frame_layout_.get(); }
  VkDescriptorSetLayout material_layout() const { return material_layout_.get(); }
  VkDescriptorSet frame_set() const { return frame_set_; }
  VkDescriptorSet material_set(uint32_t material) const { return material_sets_[material]; }
  VkBuffer positions() const { return positions_.handle(); }  // binding 0: float x, y, z
  VkBuffer attributes() const {
    return attributes_.handle();
  }                                                       // binding 1: normal, uv, colour (VertexAttributes)
  VkBuffer indices() const { return indices_.handle(); }  // uint32
  uint32_t first_vertex(uint32_t mesh) const { return first_vertex_[mesh]; }
  uint32_t first_triangle(uint32_t mesh) const { return first_triangle_[mesh]; }

  // Moves the scene to a time of its animation, and writes what has changed; the
  // device must not be reading it. Frame 0 begins a sequence: it has no previous frame.
  void update(const FrameView& view, double seconds, uint32_t frame_index);

  // Since the frame before; all true in frame 0.
  bool casters_changed() const { return casters_changed_; }  // some instance has moved or changed its shape
  bool light_changed(uint32_t light) const {
    return lights_changed_[light];
  }                                                        // it has moved, or its intensity
  bool camera_changed() const { return camera_changed_; }  // its place or the view's shape

 private:
  void upload_geometry();
  void upload_textures();
  void make_frame_set();
  void make_material_sets();
  void pose(double seconds, bool first);
  void update_meshes(const Pose& pose);

  std::shared_ptr<Device> device_;
  std::shared_ptr<Scene> moving_;  // null: nothing moves
  std::shared_ptr<const Scene> scene_;
  std::vector<Draw> draws_;
  Camera camera_;  // of the frame before
  FrameView view_;
  bool casters_changed_ = true, camera_changed_ = true;
  std::vector<bool> lights_changed_;  // per light
  std::vector<uint32_t> first_vertex_, first_triangle_;
  FrameData frame_{};
  Buffer positions_, attributes_, indices_, triangle_normals_, materials_;
  Buffer frame_buffer_, lights_, instances_;  // host-visible
  std::vector<GpuImage> textures_;            // last one: plain white
  std::vector<Handle<VkSampler>> samplers_;
  Handle<VkDescriptorPool> pool_;
  Handle<VkDescriptorSetLayout> frame_layout_, material_layout_;
  VkDescriptorSet frame_set_ = VK_NULL_HANDLE;
  std::vector<VkDescriptorSet> material_sets_;
};

// Octahedral map of a unit vector to [-1, 1]^2 (Cigolle et al. 2014), as snorm16.
glm::i16vec2 octahedral_snorm16(const glm::vec3& unit);

}  // namespace gnomon
