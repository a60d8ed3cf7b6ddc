// What a pass is given to make its pipelines and buffers, once.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/params.h"
#include "engine/base/shape.h"
#include "engine/render/left_out.h"
#include "engine/vulkan/pipeline.h"
#include "engine/vulkan/resources.h"

namespace gnomon {

class GpuScene;          // engine/render/gpu_scene.h
class OcclusionQueries;  // engine/vulkan/occlusion_queries.h
struct NodeState;        // engine/render/device_plan.h
struct Physical;         // engine/render/device_plan.h
struct PlanNode;         // engine/plan/compile.h
struct RenderSettings;   // engine/render/render_settings.h
struct Scene;            // engine/scene/scene.h
struct SceneFacts;       // engine/light/scene_facts.h
struct ViewSet;          // engine/light/view_set.h

class Environment {
 public:
  Environment(std::shared_ptr<Device> device, const GpuScene& scene, const SceneFacts& scene_facts,
              const RenderSettings& settings, const PlanNode& node, const NodeState& state,
              const std::vector<Physical>& resources, VkPipelineCache cache);

  const Scene& scene() const;
  const SceneFacts& scene_facts() const { return scene_facts_; }  // with keep_all they promise nothing
  const GpuScene& gpu_scene() const { return scene_; }
  const RenderSettings& settings() const { return settings_; }
  const std::string& id() const;
  const Params& params() const;
  const Device& device() const { return *device_; }
  ImageShape shape(const std::string& port) const;
  bool connected(const std::string& port) const;  // of an optional input, or an output that may be omitted
  // How far from receivers' places the texels of an output that is a shadow map are read; none: anywhere.
  std::optional<uint32_t> reach(const std::string& output) const;

  // The views in a buffer port, as the host knows them: those of the frame that is recorded last, or, when
  // they are made on the device, ones that hold all that those may. Known from when their maker is prepared.
  const ViewSet& views(const std::string& port) const;
  void publish(const std::string& port, ViewSet views) const;  // of an output of this pass

  // Pipelines of this pass: its bindings, its parameter block and flags are in the preamble of every shader.
  Pipeline compute(const std::string& file, Defines defines = {}) const;
  Pipeline raster(RasterState state) const;

  // A buffer of this content that lives as long as the caller keeps it.
  Buffer upload(std::span<const std::byte> bytes, VkBufferUsageFlags usage) const;
  // What a kept buffer port that the pass declares transfer_write holds before the first frame, from its
  // start. Error: it is longer than the port.
  void write(const std::string& port, std::span<const std::byte> bytes) const;
  // Error: this device cannot halve the port's format (Context::generate_mips).
  void check_mips(const std::string& port) const;

  void fact(const std::string& name, double value);  // for run.json
  // Queries for Context::query, all of one size.
  OcclusionQueries occlusion_queries(uint32_t count) const;

  // Tells that a part of this pass does not run for this scene, and by which fact.
  void left_out(std::string part, std::string reason);
  const std::vector<LeftOutPass>& left_out() const { return left_out_; }

  void warn(std::string sentence);
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

}  // namespace gnomon
