// What every technique that tests camera pixels against a shadow map has in common: ports and what
// the map says of itself, as shaders/glsl/map/shadow_query.glsl uses them.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/vulkan/pipeline.h"

namespace gnomon {

// Inputs `depth`, `geometric`, `shadow_map` and, behind it, `views`; the map says `encoding`, `bias`,
// `bias_constant`, `bias_slope`, `bias_normal` (map_traits.h). Returns the shape of a visibility image: one
// layer a light.
ImageShape declare_receiver(Declaration& d, Access depth = Access::sampled);

// Parameter `kernel`: width of a filter in the shadow map, odd, in texels.
int64_t declare_kernel(Declaration& d);

// One compute shader in a form for each number of views that a light may have (LIGHT_VIEWS): a pixel of a
// light with several finds the one that shows it. The pass has the input `views`.
class LightPipelines {
 public:
  void prepare(Environment& e, const std::string& file, const Defines& defines = {});
  const Pipeline& of(const Context& c, uint32_t light) const;

 private:
  std::map<uint32_t, Pipeline> by_views_;
};

// What a pass makes, an image with a layer a light, and the shader that fills the layer of a light whose
// shadows the camera cannot see.
struct PerLightOutput {
  std::string port = "visibility", shadowless = "frame/unshadowed.glsl";
};

// A compute shader that includes shadow_query.glsl, run for one light at a time.
class PerLight {
 public:
  void prepare(Environment& e, const std::string& file, const Defines& defines = {},
               const PerLightOutput& output = {});
  // Lights whose shadows the camera cannot see (SceneFacts): fills the output without the shader. Then true.
  bool shade_shadowless(Context& c, uint32_t light) const;
  void dispatch_over(Context& c, uint32_t light, Extent pixels) const;
  // One invocation per pixel of the output, light by light.
  void dispatch_all(Context& c) const;
  // `part`: for passes that do their work in several dispatches.
  void dispatch_indirect(Context& c, uint32_t light, const std::string& port,
                         std::array<uint32_t, 2> part = {}) const;

 private:
  const Pipeline& ready(Context& c, uint32_t light,
                        std::array<uint32_t, 2> part = {}) const;  // push constants too
  LightPipelines pipelines_;
  std::string output_;
  std::vector<bool> shadowless_;  // per light
  Pipeline unshadowed_;           // only when some light is
};

// Puts the biases' size in world units into run.json, at the middle of each map view's depth range.
void report_bias(Environment& e);

}  // namespace gnomon
