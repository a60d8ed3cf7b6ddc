// Renders the shadow maps of an area light's samples, layer by layer.
#include "passes/area/sample_maps.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "engine/base/sobol.h"
#include "engine/graph/pass.h"
#include "engine/light/light_fit.h"
#include "engine/light/light_view.h"
#include "engine/light/scene_facts.h"
#include "engine/light/view_set.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/frame_data.h"
#include "engine/render/gpu_scene.h"
#include "engine/scene/area_light.h"
#include "engine/scene/scene.h"
#include "passes/map/map_domain.h"
#include "passes/map/map_traits.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

struct AreaData {  // of shaders/glsl/area/light_samples.glsl: rows, range, info
  glm::vec4 rows[3], range;
  glm::uvec4 info;
};
struct SampleData {  // offset and weight, window
  glm::vec4 offset_weight, window;
};

// Where a point of the light is in the frame of one of its views.
glm::dvec3 offset_in(const Scene& scene, const LightView& view, const glm::dvec2& local) {
  const glm::dmat3 turn(view.light_from_world * scene.lights[view.light].world_from_light);
  return turn * glm::dvec3(local, 0.0);
}

// Points of a sphere around a point light, or directions to a sun, are no samples with maps of their own yet.
void warn_about_sizes(Environment& e) {
  const SceneFacts& facts = e.scene_facts();
  for (uint32_t i = 0; i < facts.lights; ++i) {
    const Light& light = e.scene().lights[i];
    if (!has_size(light) || shines_as_area(light)) continue;
    if (facts.shadowless[i].empty() && !facts.shines_as_point(i))
      e.warn("light '" + light.name +
             "' is sampled in its centre alone: only spot lights are sampled as areas");
  }
}

// A part of a texel, within half of one, that a sample's window is moved by: where windows converge the
// texels of all samples would coincide, and so would their errors. The centre's stays: a light without size
// has the hard techniques' map.
glm::dvec2 texel_shift(const glm::dvec2& local) {
  if (local == glm::dvec2(0.0)) return local;
  const auto bits = [](double value) {
    const uint64_t all = std::bit_cast<uint64_t>(value + 0.0);  // + 0: one zero, not two
    return hash_combine(uint32_t(all), uint32_t(all >> 32));
  };
  const uint32_t mixed = hash_combine(bits(local.x), bits(local.y));
  constexpr double kHalf = 65536.0;
  return glm::dvec2(mixed & 0xFFFFu, mixed >> 16) / kHalf - 0.5;
}

}  // namespace

uint32_t SampleMaps::declare_views(Declaration& d) {
  const BufferShape views = d.input_buffer("views", Access::uniform, "the lights' views from their centres");
  d.offer_behind("views", "visibility");
  return uint32_t(views.count);
}

ImageShape SampleMaps::declare(Declaration& d, uint32_t wanted, bool cache, double share) {
  const ImageShape depth = d.input("depth", Access::sampled, false, "the camera's device depth");
  d.input("geometric", Access::sampled, false, "octahedral geometric normal");
  const uint32_t size =
      uint32_t(d.integer("size", 1024, 1, 16384, "texels", "side of each sample's shadow map"));
  if (declare_depth_map(d).bias == "midpoint")
    d.refuse("bias", "a method that needs one surface of each map");
  constexpr uint64_t kTexelBytes = 4;
  const auto fitting = uint64_t(share * double(d.setting().memory)) / (kTexelBytes * size * size);
  const uint32_t most = cache ? wanted : std::min(wanted, kMostLayers);
  const uint32_t layers = uint32_t(std::clamp<uint64_t>(fitting, 1, most));
  const ImageShape maps{{size, size}, layers, 1, VK_FORMAT_D32_SFLOAT};
  constexpr Access kMaps = Access::depth | Access::sampled;
  d.transient("maps", kMaps, true, maps, "depth from the samples rendered at a time, a layer each");
  draws_maps(d, "maps", "size");
  if (cache) d.keep("maps");
  return {depth.extent, d.setting().lights, 1, VK_FORMAT_R32_SFLOAT};
}

void SampleMaps::declare_samples(Declaration& d, uint64_t views, uint64_t capacity) {
  constexpr Access kFromHost = Access::storage_read | Access::host_write;
  constexpr uint32_t kStride = sizeof(glm::vec4);
  d.transient_buffer("areas", kFromHost, {views * sizeof(AreaData) / kStride, kStride, "vec4"},
                     "the lights' views, widened for their samples");
  d.transient_buffer("samples", kFromHost, {capacity * sizeof(SampleData) / kStride, kStride, "vec4"},
                     "place and weight of each sample");
}

void SampleMaps::prepare(Environment& e, bool split) {
  layers_ = e.shape("maps").layers;
  size_ = e.shape("maps").extent.width;
  warn_about_maps(e, size_, MapsFrom::area);
  warn_about_sizes(e);
  RasterState state;
  state.vertex = "area/sample_maps.vert.glsl";
  state.depth = VK_FORMAT_D32_SFLOAT;
  state.depth_test = state.depth_write = true;
  state.depth_clamp = true;  // what is nearer than the view's range casts its shadow all the same
  state.depth_compare = VK_COMPARE_OP_LESS;
  if (split) state.defines.emplace_back("SPLIT_MOVING", "1");
  for (const Instance& instance : e.scene().instances) split_.push_back({{instance.moving ? 1u : 0u, 1u}});
  const bool linear = e.params().choice("encoding") == "linear";
  if (linear) {
    state.defines.emplace_back("LINEAR_DEPTH", "1");
    state.fragment = "map/shadow_map.glsl";
  }
  cull_ = e.params().choice("bias") == "back_face" ? Cull::front : Cull::none;
  pipelines_.opaque = e.raster(state);
  state.defines.emplace_back("MASKED", "1");
  state.fragment = "map/shadow_map.glsl";
  state.layout = VertexLayout::masked;
  pipelines_.masked = e.raster(state);
}

void SampleMaps::begin(Context& c) {
  const ViewSet& set = c.views("views");
  const std::vector<LightView>& views = set.views;
  widened_.resize(views.size()), converge_.resize(views.size());
  for (uint32_t i = 0; i < views.size(); ++i) {
    if (!set.changed[views[i].light] && !c.scene().casters_changed()) continue;
    const AreaView area = area_view(c.scene().scene(), views[i]);
    widened_[i] = area.view, converge_[i] = area.converge;
  }
  auto* out = reinterpret_cast<AreaData*>(c.buffer("areas").bytes().data());
  for (const LightViewData& data :
       light_view_data(widened_, glm::dvec3(c.scene().camera().world_from_camera[3]))) {
    std::copy(std::begin(data.rows), std::end(data.rows), out->rows);
    out->range = data.range;
    (out++)->info = data.info;
  }
}

void SampleMaps::write(const Context& c, uint32_t view, uint32_t first, std::span<const LightPoint> points) {
  auto* out = reinterpret_cast<SampleData*>(c.buffer("samples").bytes().data()) + first;
  for (const LightPoint& point : points) {
    const glm::dvec3 offset = offset_in(c.scene().scene(), c.views("views").views[view], point.local);
    const LightView& wide = widened_[view];
    const LightView& own = c.views("views").views[view];
    const glm::dvec2 texel = 2.0 * glm::dvec2(wide.half_width, wide.half_height) / double(size_);
    // Of a light so small that its samples' maps differ by less than a texel, no further than they differ.
    const glm::dvec2 apart(wide.half_width - own.half_width, wide.half_height - own.half_height);
    const glm::dvec2 shift = glm::min(texel, apart) * texel_shift(point.local);
    out->offset_weight = glm::vec4(offset, point.weight);
    (out++)->window = glm::vec4(shift - converge_[view] * glm::dvec2(offset), point.layer, 0.0);
  }
}

void SampleMaps::push(Context& c, uint32_t view, uint32_t first) const {
  constexpr uint32_t kAfterDraw = 8;  // bytes: Context::draw pushes what comes before
  c.push(pipelines_.opaque, std::array<uint32_t, 2>{view, first}, kAfterDraw);
}

void SampleMaps::render(Context& c, uint32_t view, uint32_t first, uint32_t count, uint32_t layer) {
  Targets targets{{}, DepthTarget{"maps", 1.0f}, layer};
  targets.layers = count;
  push(c, view, first);
  c.render(targets, [&] { c.draw_scene(pipelines_, cull_, count); });
}

void SampleMaps::render_split(Context& c, uint32_t view, uint32_t sample) {
  Targets targets{{}, DepthTarget{"maps", 1.0f}, 0};
  targets.layers = 2;
  push(c, view, sample);
  c.render(targets, [&] { c.draw_scene(pipelines_, cull_, split_); });
}

void tell_left_out(Environment& e) {
  const SceneFacts& facts = e.scene_facts();
  for (uint32_t i = 0; i < facts.lights; ++i) {
    const Light& light = e.scene().lights[i];
    if (!facts.shadowless[i].empty())
      e.left_out("maps of light '" + light.name + "'", facts.shadowless[i]);
    else if (shines_as_area(light) && facts.shines_as_point(i))
      e.left_out("area of light '" + light.name + "'", "its penumbrae are far narrower than a pixel");
  }
}

}  // namespace gnomon
