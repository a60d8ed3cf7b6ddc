// Shadow maps of an area light's samples, layer by layer, as shaders/glsl/area/light_samples.glsl and
// area_query.glsl see them.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/graph/pass.h"
#include "engine/light/light_view.h"
#include "engine/render/context.h"
#include "engine/render/raster.h"
#include "engine/vulkan/pipeline.h"
#include "engine/vulkan/resources.h"
#include "passes/map/receiver_ports.h"

namespace gnomon {

struct LightPoint {  // a sample
  glm::dvec2 local;  // on the light, its own x and y in world units
  double weight = 1;
  uint32_t layer = 0;  // of its map, where a pass does not push it
};

class SampleMaps {
 public:
  // Samples whose bits fit a word of shaders; more are never rendered at a time.
  static constexpr uint32_t kMostLayers = 32;

  // Input `views`; returns how many there are.
  static uint32_t declare_views(Declaration& d);
  // Inputs `depth`, `geometric`; parameters `size` and those of a shadow test; transient `maps`. The maps
  // take as much of the memory limit as they can use: `wanted` layers at most, all of them kept from frame to
  // frame when `cache`. `share`: of the limit. Returns the shape of a visibility image: one layer a light.
  static ImageShape declare(Declaration& d, uint32_t wanted, bool cache, double share = 1);

  // Transients `areas`, for so many views, and `samples`, for at most `capacity` over all views.
  static void declare_samples(Declaration& d, uint64_t views, uint64_t capacity);

  // `split`: render_split() is used instead of render().
  void prepare(Environment& e, bool split = false);
  // The frame's light views.
  void begin(Context& c);
  // Writes samples [first, first + points.size()), of the view's light.
  void write(const Context& c, uint32_t view, uint32_t first, std::span<const LightPoint> points);
  uint32_t layers() const { return layers_; }
  // Renders samples [first, first + count) of a view to layers from `layer` on, keeping the others.
  void render(Context& c, uint32_t view, uint32_t first, uint32_t count, uint32_t layer);
  // Renders one sample of a view: what stands still to layer 0, instances that some animation moves to
  // layer 1.
  void render_split(Context& c, uint32_t view, uint32_t sample);

 private:
  void push(Context& c, uint32_t view, uint32_t first) const;
  ScenePipelines pipelines_;
  InstanceLayers split_;  // of render_split()
  Cull cull_ = Cull::none;
  std::vector<LightView> widened_;  // AreaView, per view
  std::vector<double> converge_;
  uint32_t layers_ = 0, size_ = 1;
};

// Tells which lights need no maps, and which only one, of their centres.
void tell_left_out(Environment& e);

// What area_query.glsl is pushed.
struct AreaPush {
  uint32_t light, view, first, count, layer, bit;
  std::array<uint32_t, 2> part{};
};

// A compute shader that includes area_query.glsl.
class AreaShader {
 public:
  void prepare(Environment& e, const std::string& file, const Defines& defines = {}) {
    pipelines_.prepare(e, file, defines);
  }
  const Pipeline& ready(Context& c, const AreaPush& push) const {  // pushed
    const Pipeline& pipeline = pipelines_.of(c, push.light);
    c.push(pipeline, push);
    return pipeline;
  }

 private:
  LightPipelines pipelines_;
};

}  // namespace gnomon
