// Ports of everything that tests camera pixels against a shadow map.
#include "passes/map/receiver_ports.h"
#include "engine/graph/pass.h"
#include "engine/light/light_view.h"
#include "engine/light/scene_facts.h"
#include "engine/light/view_set.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/gpu_scene.h"
#include "engine/scene/scene.h"
#include "passes/map/map_traits.h"

#include <fmt/format.h>

#include <algorithm>

namespace gnomon {
ImageShape declare_receiver(Declaration& d, Access access) {
  const ImageShape depth = d.input("depth", access, false, "the camera's device depth");
  d.input("geometric", Access::sampled, false, "octahedral geometric normal");
  d.input("shadow_map", Access::sampled, true, "depth from the light, a layer a view");
  d.input_behind("views", "shadow_map", Access::uniform, "what the map's layers show");
  d.offer_behind("shadow_map", "visibility");
  read_depth_map(d, "shadow_map");
  return {depth.extent, d.setting().lights, 1, VK_FORMAT_R32_SFLOAT};
}

int64_t declare_kernel(Declaration& d) {
  const int64_t width = d.integer("kernel", 15, 1, 63, "texels", "width of the filter, odd");
  if (width % 2 == 0) d.refuse("kernel", "odd");
  return width;
}

void LightPipelines::prepare(Environment& e, const std::string& file, const Defines& defines) {
  for (const ViewSet::Range& views : e.views("views").of_light) {
    Pipeline& pipeline = by_views_[views.count];
    if (pipeline.handle) continue;
    Defines all = defines;
    all.emplace_back("LIGHT_VIEWS", std::to_string(views.count));
    pipeline = e.compute(file, all);
  }
}

const Pipeline& LightPipelines::of(const Context& c, uint32_t light) const {
  return by_views_.at(c.views("views").of_light[light].count);
}

void PerLight::prepare(Environment& e, const std::string& file, const Defines& defines,
                       const PerLightOutput& output) {
  pipelines_.prepare(e, file, defines);
  output_ = output.port;
  for (const std::string& why : e.scene_facts().shadowless) shadowless_.push_back(!why.empty());
  if (std::find(shadowless_.begin(), shadowless_.end(), true) != shadowless_.end())
    unshadowed_ = e.compute(output.shadowless);
}

bool PerLight::shade_shadowless(Context& c, uint32_t light) const {
  if (!shadowless_[light]) return false;
  c.push(unshadowed_, light);
  c.dispatch_over(unshadowed_, c.shape(output_).extent);
  return true;
}

const Pipeline& PerLight::ready(Context& c, uint32_t light, std::array<uint32_t, 2> part) const {
  const uint32_t first = c.views("views").of_light[light].first;
  const Pipeline& pipeline = pipelines_.of(c, light);
  c.push(pipeline, std::array<uint32_t, 4>{light, first, part[0], part[1]});
  return pipeline;
}

void PerLight::dispatch_over(Context& c, uint32_t light, Extent pixels) const {
  c.dispatch_over(ready(c, light), pixels);
}

void PerLight::dispatch_all(Context& c) const {
  const ImageShape shape = c.shape(output_);
  for (uint32_t light = 0; light < shape.layers; ++light)
    if (!shade_shadowless(c, light)) dispatch_over(c, light, shape.extent);
}

void PerLight::dispatch_indirect(Context& c, uint32_t light, const std::string& port,
                                 std::array<uint32_t, 2> part) const {
  c.dispatch_indirect(ready(c, light, part), port);
}

void report_bias(Environment& e) {
  const double size = e.shape("shadow_map").extent.width;
  const auto& views = e.views("views").views;
  for (uint32_t i = 0; i < views.size(); ++i) {
    const LightView& view = views[i];
    const double half = std::max(view.half_width, view.half_height);
    const double texel = 2.0 * half * (view.orthographic ? 1.0 : 0.5 * (view.near + view.far)) / size;
    const std::string suffix = views.size() > 1 ? fmt::format(".view{}", i) : std::string();
    e.fact("texel_world" + suffix, texel);
    e.fact("bias_constant_world" + suffix, texel * e.params().number("bias_constant"));
    e.fact("bias_slope_world" + suffix, texel * e.params().number("bias_slope"));
    e.fact("bias_normal_world" + suffix, texel * e.params().number("bias_normal"));
  }
}

}  // namespace gnomon
