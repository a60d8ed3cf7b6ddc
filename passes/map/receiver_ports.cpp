// Ports of everything that tests camera pixels against a shadow map.
#include "passes/map/receiver_ports.h"
#include "engine/graph/pass.h"
#include "engine/light/light_face.h"
#include "engine/light/scene_facts.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/gpu_scene.h"
#include "engine/scene/scene.h"
#include "passes/map/map_traits.h"

#include <fmt/format.h>

#include <algorithm>

namespace gnomon {
ImageShape declare_receiver(Declaration& d) {
  const ImageShape depth = d.input("depth", Access::sampled, false, "the camera's device depth");
  d.input("geometric", Access::sampled, false, "octahedral geometric normal");
  d.input("shadow_map", Access::sampled, true, "depth from the light, a layer a face");
  read_depth_map(d, "shadow_map");
  return {depth.extent, d.setting().lights, 1, VK_FORMAT_R32_SFLOAT};
}

int64_t declare_kernel(Declaration& d) {
  const int64_t width = d.integer("kernel", 15, 1, 63, "texels", "width of the filter, odd");
  if (width % 2 == 0) d.refuse("kernel", "odd");
  return width;
}

void LightPipelines::prepare(Environment& e, const std::string& file, const Defines& defines) {
  for (const Light& light : e.scene().lights) {
    const bool point = light.type == LightType::point;
    Pipeline& pipeline = point ? six_faces_ : one_face_;
    if (pipeline.handle) continue;
    Defines all = defines;
    if (point) all.emplace_back("SIX_FACES", "1");
    pipeline = e.compute(file, all);
  }
}

const Pipeline& LightPipelines::of(const Context& c, uint32_t light) const {
  return c.scene().scene().lights[light].type == LightType::point ? six_faces_ : one_face_;
}

void PerLight::prepare(Environment& e, const std::string& file, const Defines& defines) {
  pipelines_.prepare(e, file, defines);
  for (const std::string& why : e.scene_facts().shadowless) shadowless_.push_back(!why.empty());
  if (std::find(shadowless_.begin(), shadowless_.end(), true) != shadowless_.end())
    unshadowed_ = e.compute("frame/unshadowed.glsl");
}

bool PerLight::shade_shadowless(Context& c, uint32_t light) const {
  if (!shadowless_[light]) return false;
  c.push(unshadowed_, light);
  c.dispatch_over(unshadowed_, c.shape("visibility").extent);
  return true;
}

const Pipeline& PerLight::ready(Context& c, uint32_t light, std::array<uint32_t, 2> part) const {
  const auto& faces = c.scene().faces();
  uint32_t first = 0;
  while (first < faces.size() && faces[first].light != light) ++first;
  const Pipeline& pipeline = pipelines_.of(c, light);
  c.push(pipeline, std::array<uint32_t, 4>{light, first, part[0], part[1]});
  return pipeline;
}

void PerLight::dispatch_over(Context& c, uint32_t light, Extent pixels) const {
  c.dispatch_over(ready(c, light), pixels);
}

void PerLight::dispatch_all(Context& c) const {
  const ImageShape shape = c.shape("visibility");
  for (uint32_t light = 0; light < shape.layers; ++light)
    if (!shade_shadowless(c, light)) dispatch_over(c, light, shape.extent);
}

void PerLight::dispatch_indirect(Context& c, uint32_t light, const std::string& port,
                                 std::array<uint32_t, 2> part) const {
  c.dispatch_indirect(ready(c, light, part), port);
}

void report_bias(Environment& e) {
  const double size = e.shape("shadow_map").extent.width;
  const auto& faces = e.gpu_scene().faces();
  for (uint32_t i = 0; i < faces.size(); ++i) {
    const LightFace& face = faces[i];
    const double half = std::max(face.half_width, face.half_height);
    const double texel = 2.0 * half * (face.orthographic ? 1.0 : 0.5 * (face.near + face.far)) / size;
    const std::string suffix = faces.size() > 1 ? fmt::format(".face{}", i) : std::string();
    e.fact("texel_world" + suffix, texel);
    e.fact("bias_constant_world" + suffix, texel * e.params().number("bias_constant"));
    e.fact("bias_slope_world" + suffix, texel * e.params().number("bias_slope"));
    e.fact("bias_normal_world" + suffix, texel * e.params().number("bias_normal"));
  }
}

}  // namespace gnomon
