// What a pass is given: Environment to make its pipelines once, Context to record its commands each time.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/light/scene_facts.h"
#include "engine/plan/compile.h"
#include "engine/render/device_plan.h"
#include "engine/render/gpu_scene.h"
#include "engine/render/renderer.h"
#include "engine/vulkan/occlusion_queries.h"
#include "engine/vulkan/pipeline.h"

namespace gnomon {

class Environment {
 public:
  Environment(std::shared_ptr<Device> device, const GpuScene& scene, const SceneFacts& scene_facts,
              const RenderSettings& settings, const PlanNode& node, const NodeState& state,
              const std::vector<Physical>& resources, VkPipelineCache cache);

  const Scene& scene() const { return scene_.scene(); }
  const SceneFacts& scene_facts() const { return scene_facts_; }  // with keep_all they promise nothing
  const GpuScene& gpu_scene() const { return scene_; }
  const RenderSettings& settings() const { return settings_; }
  const std::string& id() const { return node_.id; }
  const Params& params() const { return node_.params; }
  const Device& device() const { return *device_; }
  ImageShape shape(const std::string& port) const;
  bool connected(const std::string& port) const;  // of an optional input, or an output that may be omitted
  // How far from receivers' places the texels of an output that is a shadow map are read; none: anywhere.
  std::optional<uint32_t> reach(const std::string& output) const;

  // Pipelines of this pass: its bindings, its parameter block and flags are in the preamble of every shader.
  Pipeline compute(const std::string& file, Defines defines = {}) const;
  Pipeline raster(RasterState state) const;

  // Buffers that live as long as the pass, for what only prepare() knows the size or the content of.
  Buffer buffer(uint64_t bytes, VkBufferUsageFlags usage) const;
  Buffer upload(std::span<const std::byte> bytes, VkBufferUsageFlags usage) const;
  // Shaders see `buffer`, which must outlive the pass' use, instead of the buffer port's own memory. Barriers
  // are the pass' business.
  void attach(const std::string& port, const Buffer& buffer) const;
  // Error: this device cannot halve the port's format (Context::generate_mips).
  void check_mips(const std::string& port) const;

  void fact(const std::string& name, double value) { facts_[node_.id + "." + name] = value; }  // for run.json
  // Queries for Context::query, all of one size.
  OcclusionQueries occlusion_queries(uint32_t count) const { return {device_, count}; }
  // Memory that the host writes and shaders read; visible to every later submission.
  Buffer host_buffer(uint64_t bytes, VkBufferUsageFlags usage) const;

  // Tells that a part of this pass does not run for this scene, and by which fact.
  void left_out(std::string part, std::string reason) {
    left_out_.push_back({node_.id, std::move(part), std::move(reason)});
  }
  const std::vector<LeftOutPass>& left_out() const { return left_out_; }

  void warn(std::string sentence) { warnings_.push_back(node_.id + ": " + std::move(sentence)); }
  const std::map<std::string, double>& facts() const { return facts_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  Defines with_parameters(Defines defines) const;
  std::shared_ptr<Device> device_;
  const GpuScene& scene_;
  const SceneFacts& scene_facts_;
  const RenderSettings& settings_;
  const PlanNode& node_;
  const NodeState& state_;
  const std::vector<Physical>& resources_;
  VkPipelineCache cache_;
  std::map<std::string, double> facts_;
  std::vector<std::string> warnings_;
  std::vector<LeftOutPass> left_out_;
};

struct ColorTarget {
  std::string port;
  std::optional<std::array<float, 4>> clear;     // absent: keep what is there
  std::optional<uint32_t> layer = std::nullopt;  // this one alone, whatever Targets::layer says
};
struct DepthTarget {
  std::string port;
  std::optional<float> clear;
  uint32_t clear_stencil = 0;
};
struct Targets {
  std::vector<ColorTarget> colors;
  std::optional<DepthTarget> depth;
  // `layers` layers of arrays from this one on (of an image with fewer, the last), gl_Layer counted from it;
  // absent: all.
  std::optional<uint32_t> layer;
  uint32_t layers = 1;
};

enum class Cull {
  material,  // glTF: back faces, unless the material is double-sided
  none,
  front  // front faces, unless the material is double-sided
};
struct ScenePipelines {
  Pipeline opaque, masked;  // masked: alpha-masked materials
};

// Which layers each instance of the scene is drawn into.
struct LayerRun {
  uint32_t first, count;
};
using InstanceLayers = std::vector<std::vector<LayerRun>>;  // [instance]

class Context {
 public:
  // `previous`: of resources with history, the copy of the frame before.
  Context(VkCommandBuffer commands, const GpuScene& scene, const PlanNode& node, const NodeState& state,
          const std::vector<Physical>& resources, const std::vector<Physical>& previous, uint32_t iteration,
          std::function<void(std::string_view)> section = {});

  VkCommandBuffer commands() const { return commands_; }
  const Params& params() const { return node_.params; }
  const GpuScene& scene() const { return scene_; }
  uint32_t iteration() const { return iteration_; }  // of the enclosing loop, from 0
  ImageShape shape(const std::string& port) const;
  const Buffer& buffer(const std::string& port) const;

  void bind(const Pipeline& pipeline);
  template <class T>
  void push(const Pipeline& pipeline, const T& values, uint32_t offset = 0) {
    vkCmdPushConstants(commands_, pipeline.layout, VK_SHADER_STAGE_ALL, offset, sizeof(T), &values);
  }

  // Compute. dispatch_over: one invocation per pixel and layer, workgroups of 8x8x1.
  void dispatch(const Pipeline& pipeline, uint32_t x, uint32_t y = 1, uint32_t z = 1);
  void dispatch_over(const Pipeline& pipeline, Extent pixels, uint32_t layers = 1);
  void dispatch_indirect(const Pipeline& pipeline, const std::string& port, uint64_t offset = 0);
  void fill(const std::string& buffer_port, uint32_t value, uint64_t offset = 0,
            uint64_t size = VK_WHOLE_SIZE);
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

  // Raster. `body` records draws.
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
  // Occlusion: reset() outside render(), query() inside it, around draws; then results() to a buffer that the
  // pass declares transfer_write: two words a query, the number of samples that passed (any number but 0 when
  // the device only tells whether there are some) and whether the query was answered.
  void reset(const OcclusionQueries& queries);
  void query(const OcclusionQueries& queries, uint32_t index, const std::function<void()>& draws);
  void results(const OcclusionQueries& queries, uint32_t count, const std::string& buffer_port);

 private:
  const Physical& physical(const std::string& port) const;
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
};

}  // namespace gnomon
