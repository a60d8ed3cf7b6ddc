// What a pass is given to record its commands, each time it runs.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/base/params.h"
#include "engine/base/shape.h"
#include "engine/render/raster.h"
#include "engine/vulkan/pipeline.h"
#include "engine/vulkan/resources.h"

namespace gnomon {

class GpuScene;          // engine/render/gpu_scene.h
class OcclusionQueries;  // engine/vulkan/occlusion_queries.h
struct NodeState;        // engine/render/device_plan.h
struct Physical;         // engine/render/device_plan.h
struct PlanNode;         // engine/plan/compile.h
struct ViewSet;          // engine/light/view_set.h

class Context {
 public:
  // `previous`: of resources with history, the copy of the frame before.
  Context(VkCommandBuffer commands, const GpuScene& scene, const PlanNode& node, const NodeState& state,
          const std::vector<Physical>& resources, const std::vector<Physical>& previous, uint32_t iteration,
          std::function<void(std::string_view)> section = {});

  VkCommandBuffer commands() const { return commands_; }
  const Params& params() const;
  const GpuScene& scene() const { return scene_; }
  uint32_t iteration() const { return iteration_; }  // of the enclosing loop, from 0
  ImageShape shape(const std::string& port) const;
  const Buffer& buffer(const std::string& port) const;
  const ViewSet& views(const std::string& port) const;  // as Environment has them
  void publish(const std::string& port, ViewSet views) const;

  void bind(const Pipeline& pipeline);
  template <class T>
  void push(const Pipeline& pipeline, const T& values, uint32_t offset = 0) {
    static_assert(std::is_trivially_copyable_v<T>);
    push_bytes(pipeline, std::as_bytes(std::span(&values, 1)), offset);
  }

  // Compute. dispatch_over: one invocation per pixel and layer, workgroups of 8x8x1.
  void dispatch(const Pipeline& pipeline, uint32_t x, uint32_t y = 1, uint32_t z = 1);
  void dispatch_over(const Pipeline& pipeline, Extent pixels, uint32_t layers = 1);
  void dispatch_indirect(const Pipeline& pipeline, const std::string& port, uint64_t offset = 0);
  void fill(const std::string& buffer_port, uint32_t value, uint64_t offset = 0,
            uint64_t size = VK_WHOLE_SIZE);
  // Bytes to a buffer that the pass declares transfer_write: at most 65536; size and offset multiples of 4.
  void update(const std::string& buffer_port, std::span<const std::byte> bytes, uint64_t offset = 0);
  // All texels of an image of 32-bit integers or floats (its bits) that the pass declares transfer_write.
  void clear(const std::string& image_port, uint32_t value);
  // Tightly packed texels to such an image's mip 0: all of it, or rows of a layer.
  void copy(const Buffer& from, const std::string& image_port);
  struct Rows {
    uint32_t layer, first, count;
  };
  void copy_rows(const Buffer& from, const std::string& image_port, const Rows& rows);
  // Fills an output's mip levels from its first; its access includes storage_write and both transfers.
  void generate_mips(const std::string& port);
  // Makes everything this pass wrote so far visible to its next command.
  void own_barrier();
  // From here on, time counts to this part of the pass, a row "id.name" of its own.
  void section(std::string_view name) {
    if (section_) section_(name);
  }

  // Raster. `body` records draws: once, or, where vertex shaders cannot choose their layer, once for each.
  void render(const Targets& targets, const std::function<void()>& body);
  // Every instance of the scene `layers` times, gl_InstanceIndex counted from 0; or each one as often as it
  // has layers, gl_InstanceIndex the layer's.
  void draw_scene(const ScenePipelines& pipelines, Cull cull, uint32_t layers = 1);
  void draw_scene(const ScenePipelines& pipelines, Cull cull, const InstanceLayers& layers);
  void draw(const Draw& draw, const LayerRun& layers = {0, 1});  // after bind() and bind_geometry()
  void bind_geometry();
  void set_cull(VkCullModeFlags mode);
  void set_area(Extent extent);  // viewport and scissor: the target's upper left part, in pixels
  void draw_fullscreen(const Pipeline& pipeline);
  // A VkDrawIndirectCommand of a buffer port, without culling; vertices of a pipeline that has some come from
  // the port of bind_vertices().
  void draw_indirect(const Pipeline& pipeline, const std::string& port, uint64_t offset = 0);
  void bind_vertices(const std::string& buffer_port, uint64_t offset = 0);
  // Occlusion: reset() outside render(), query() inside it, around draws; then results() to a buffer that the
  // pass declares transfer_write: two words a query, the number of samples that passed (any number but 0 when
  // the device only tells whether there are some) and whether the query was answered.
  void reset(const OcclusionQueries& queries);
  void query(const OcclusionQueries& queries, uint32_t index, const std::function<void()>& draws);
  void results(const OcclusionQueries& queries, uint32_t count, const std::string& buffer_port);

 private:
  const Physical& physical(const std::string& port) const;
  uint32_t layers_of(const Targets& targets) const;
  void render_layers(const Targets& targets, uint32_t layers, const std::function<void()>& body);
  void push_bytes(const Pipeline& pipeline, std::span<const std::byte> bytes, uint32_t offset);
  void draw_scene(const ScenePipelines& pipelines, Cull cull,
                  const std::function<std::span<const LayerRun>(const Draw&)>& layers_of);
  void copy_region(const Buffer& from, const std::string& image_port, const Rows& rows, uint32_t layers);
  VkCommandBuffer commands_;
  const GpuScene& scene_;
  const PlanNode& node_;
  const NodeState& state_;
  const std::vector<Physical>&resources_, &previous_;
  uint32_t iteration_;
  std::function<void(std::string_view)> section_;
  std::optional<uint32_t> layer_;  // the only one that draws go to
};

}  // namespace gnomon
