// The pass area_temporal: one point of each area light a frame, accumulated over frames.
#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "engine/graph/pass.h"
#include "engine/light/light_view.h"
#include "engine/light/view_set.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/gpu_scene.h"
#include "engine/scene/area_light.h"
#include "engine/scene/scene.h"
#include "passes/area/sample_maps.h"
#include "passes/area/temporal_samples.h"
#include "passes/frame/pixel_list.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

// Bits of a push; the last: so few frames ago that shadows of then may still be there.
constexpr uint32_t kLightMoved = 1, kCastersMoved = 2, kShadowsFade = 4;
constexpr uint32_t kMapLayers = 2;  // of what stands still and of what moves

void declare_history(Declaration& d) {
  d.number("depth_tolerance", 0.01, 1e-6, 1, "view depth",
           "difference to a pixel's depth in the previous frame within which it is the same surface (5.18)");
  d.integer("most_tests", 4096, 16, 1 << 23, "1", "tests that count; older ones weigh less beyond");
  d.number("age", 0.8, 0, 1, "1", "weight of older tests from frame to frame while the light moves");
  d.number("most_moving", 8, 1, 4096, "1", "tests that count where a moving caster's shadow was");
  d.number("delta", 2, 1.125, 4096, "1",
           "tests that are forgotten each frame there, while casters move (5.16)");
}

void declare_filter(Declaration& d) {
  d.integer("blockers", 16, 1, 64, "1", "texels searched for blockers of a new pixel, k of (5.7)");
  d.number("blocker_radius", 7, 0, 1024, "texels", "how far from the receiver");
  d.integer("neighbours", 16, 1, 256, "1", "shadow-buffer texels around a pixel that its filter averages");
  d.number("spread", 0.5, 0, 16, "penumbra widths",
           "radius of the filter, over the square root of the number of tests");
  d.number("max_radius", 64, 0, 4096, "pixels", "largest radius of the filter");
  d.number("neighbour_tolerance", 0.01, 1e-6, 1, "view depth",
           "difference to a pixel's tangent plane within which a neighbour is of the same surface (5.18)");
  d.number("least_tests", 4, 1, 4096, "1",
           "tests below which the filter alone counts: 16 are advised for random points, stratified ones "
           "tell sooner");
  const double low =
      d.number("s_min", 0.02, 0, 1, "visibility", "standard error up to which the tests alone count");
  const double high =
      d.number("s_max", 0.2, 0, 1, "visibility", "standard error from which the filter alone counts");
  if (!(low < high)) d.refuse("s_max", "above s_min");
}

// Frames that a moving caster's shadow takes to fade: one test is added to it in each.
uint32_t frames_to_fade(const Params& params) {
  const double most = params.number("most_moving"), delta = params.number("delta");
  return 1 + uint32_t(std::ceil(std::max(most - delta, 0.0) / (delta - 1)));
}

class AreaTemporal : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.kind(PassKind::mixed);
    d.summary("Tests every camera pixel against one point of each area light a frame and keeps the tests.");
    d.cite("Schwaerzler 2009, ch. 5, eq. 5.1-5.18");
    const uint32_t views = SampleMaps::declare_views(d);
    const ImageShape visibility = SampleMaps::declare(d, kMapLayers, false);
    SampleMaps::declare_samples(d, views, views);
    ImageShape buffer = visibility;
    buffer.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    d.input("history", Access::storage_read, true, "`shadow_buffer` of the frame before");
    declare_history(d);
    declare_filter(d);
    constexpr Access kBoth = Access::storage_read | Access::storage_write;
    d.output("shadow_buffer", kBoth, true, buffer,
             "shadow buffer, a layer a light: tests in shadow and all tests (sums of their samples' "
             "weights), view depth "
             "(negative: a moving caster's shadow), mean distance of blockers along the light's axis, world "
             "units (0: none)");
    d.output("visibility", kBoth, true, visibility, "0 in umbra, 1 lit; a layer a light");
    makes_shadows(d, "visibility", ShadowKind::soft);
    declare_pixel_list(d, visibility.extent, "pixels of one light whose tests are too few");
    declare_pixel_list(d, visibility.extent, "pixels of one light that have no history", "fresh",
                       "fresh_arguments");
  }

  void prepare(Environment& e) override {
    const Scene& scene = e.scene();
    moving_ = std::any_of(scene.instances.begin(), scene.instances.end(),
                          [](const Instance& i) { return i.moving; });
    if (moving_ && e.shape("maps").layers < kMapLayers) {
      moving_ = false;
      e.warn("the memory limit holds one map: shadows of moving casters are not told from others");
    }
    for (uint32_t light = 0; light < scene.lights.size(); ++light) sequences_.emplace_back(scene, light);
    poses_.resize(scene.lights.size());
    maps_.prepare(e, moving_);
    prepare_shaders(e);
  }

  void record(Context& c) override {
    const auto& views = c.views("views").views;
    maps_.begin(c);
    still_frames_ = c.scene().casters_changed() ? 0 : still_frames_ + 1;
    for (uint32_t view = 0; view < views.size(); ++view) {
      if (view > 0) c.own_barrier();  // maps and list are used again
      sample(c, view);
    }
    for (size_t light = 0; light < poses_.size(); ++light)
      poses_[light] = c.scene().scene().lights[light].world_from_light;
  }

  std::map<std::string, double> figures() const override {
    return {{"light_samples", double(sequences_.size())}};
  }

 private:
  void prepare_shaders(Environment& e) {
    Defines defines{{"LIGHT_MOVED", std::to_string(kLightMoved)},
                    {"CASTERS_MOVED", std::to_string(kCastersMoved)},
                    {"SHADOWS_FADE", std::to_string(kShadowsFade)}};
    if (moving_) defines.emplace_back("MOVING_CASTERS", "1");
    hard_.prepare(e, "area/area_temporal.glsl", defines);
    defines.emplace_back("HISTORY", "1");
    still_.prepare(e, "area/area_temporal.glsl", defines);
    search_.prepare(e, "area/area_temporal_search.glsl", defines);
    filter_.prepare(e, "area/area_temporal_filter.glsl", defines);
    defines.emplace_back("CAMERA_MOVED", "1");
    reprojected_.prepare(e, "area/area_temporal.glsl", defines);
  }

  void sample(Context& c, uint32_t view) {
    const Scene& scene = c.scene().scene();
    const uint32_t light = c.views("views").views[view].light;
    c.section("map");
    maps_.write(c, view, view, std::array{sequences_[light].at(scene, c.scene().frame().counts.z)});
    moving_ ? maps_.render_split(c, view, view) : maps_.render(c, view, view, 1, 0);
    if (shines_as_area(scene.lights[light]))
      accumulate(c, push_of(c, view));
    else
      test(c, push_of(c, view));
  }

  AreaPush push_of(const Context& c, uint32_t view) const {
    const uint32_t index = c.views("views").views[view].light;
    const Light& light = c.scene().scene().lights[index];
    const bool first = c.scene().frame().counts.z == 0;
    const bool light_moved = first || poses_[index] != light.world_from_light;
    AreaPush push{index, view, view, 1, 0, 0};
    if (light_moved) push.bit |= kLightMoved;
    if (still_frames_ == 0) push.bit |= kCastersMoved;
    if (still_frames_ < frames_to_fade(c.params())) push.bit |= kShadowsFade;
    const double size = shines_as_area(light) ? std::max(light.area->width, light.area->height) : 0.0;
    push.part[0] = std::bit_cast<uint32_t>(float(size));
    return push;
  }

  // A light without area: its shadow map decides.
  void test(Context& c, const AreaPush& push) {
    c.own_barrier();
    c.section("tests");
    c.dispatch_over(hard_.ready(c, push), c.shape("visibility").extent);
  }

  void accumulate(Context& c, const AreaPush& push) {
    clear_pixel_list(c);
    clear_pixel_list(c, "fresh_arguments");
    c.own_barrier();
    c.section("tests");
    const AreaShader& tests = c.scene().camera_changed() ? reprojected_ : still_;
    c.dispatch_over(tests.ready(c, push), c.shape("visibility").extent);
    c.own_barrier();
    c.section("filter");
    c.dispatch_indirect(search_.ready(c, push), "fresh_arguments");
    c.own_barrier();
    c.dispatch_indirect(filter_.ready(c, push), "arguments");
  }

  SampleMaps maps_;
  AreaShader hard_, still_, reprojected_, search_, filter_;
  std::vector<LightSequence> sequences_;  // per light
  std::vector<glm::dmat4> poses_;         // of the lights in the frame before
  uint32_t still_frames_ = 0;             // since casters moved
  bool moving_ = false;                   // some instance may move
};

GNOMON_PASS("area_temporal", AreaTemporal);

}  // namespace
}  // namespace gnomon
