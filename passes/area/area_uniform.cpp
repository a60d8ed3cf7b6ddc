// The pass area_uniform: the average over points spread evenly on each area light.
#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "engine/graph/pass.h"
#include "engine/light/light_view.h"
#include "engine/light/scene_facts.h"
#include "engine/light/view_set.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/gpu_scene.h"
#include "engine/scene/scene.h"
#include "passes/area/area_light_points.h"
#include "passes/area/sample_maps.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

constexpr uint32_t kFirst = 1, kLast = 2;  // bits of a push: begins, ends a light's samples

bool is_square(int64_t n) {
  const auto root = int64_t(std::llround(std::sqrt(double(n))));
  return root * root == n;
}

class AreaUniform : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.kind(PassKind::mixed);
    d.summary("Tests every camera pixel against the shadow maps of points spread over each area light.");
    d.cite("Heckbert and Herf 1997; Macedo 2018, ch. 6.2 (uniform sampling), eq. 6.4");
    const int64_t n = d.integer("samples", 289, 1, 4096, "1", "points of each area light");
    const std::string pattern =
        d.choice("pattern", "grid_corners", {"grid_corners", "grid_centres", "sobol"},
                 "a regular grid with or without its end points, or Owen-scrambled Sobol points");
    if (pattern != "sobol" && !is_square(n)) d.refuse("samples", "a square number for a grid");
    const bool cache =
        d.flag("cache", false, "maps of unchanged lights and casters stay from frame to frame");
    const uint32_t views = SampleMaps::declare_views(d);
    const ImageShape visibility = SampleMaps::declare(d, uint32_t(n) * views, cache);
    SampleMaps::declare_samples(d, views, uint64_t(n) * views);
    d.output("visibility", Access::storage_read | Access::storage_write, true, visibility,
             "0 in umbra, 1 lit; a layer a light");
    makes_shadows(d, "visibility", ShadowKind::soft);
  }

  void prepare(Environment& e) override {
    test_.prepare(e, "area/area_uniform.glsl",
                  {{"PART_FIRST", std::to_string(kFirst)}, {"PART_LAST", std::to_string(kLast)}});
    choose_points(e);
    uint32_t capacity = 0;
    for (const LightView& view : e.views("views").views) capacity += uint32_t(points_[view.light].size());
    maps_.prepare(e);
    cached_ = e.params().flag("cache") && capacity <= maps_.layers();
    if (e.params().flag("cache") && !cached_)
      e.warn("cache: the memory limit holds " + std::to_string(maps_.layers()) + " of " +
             std::to_string(capacity) + " maps: none is kept");
  }

  void record(Context& c) override {
    const auto& views = c.views("views").views;
    maps_.begin(c);
    samples_ = rendered_ = 0;
    uint32_t first = 0;
    for (uint32_t view = 0; view < views.size(); ++view) {
      const std::vector<LightPoint>& all = points_[views[view].light];
      maps_.write(c, view, first, all);
      all.empty() ? test(c, view, {}, kFirst | kLast, 0) : sample(c, view, first, all);
      first += uint32_t(all.size());
    }
  }

  std::map<std::string, double> figures() const override {
    return {{"light_samples", samples_}, {"maps_rendered", rendered_}};
  }

 private:
  // Once: a light may move, but keeps its shape.
  void choose_points(Environment& e) {
    const SceneFacts& facts = e.scene_facts();
    const auto n = uint32_t(e.params().integer("samples"));
    const std::string& pattern = e.params().choice("pattern");
    points_.resize(facts.lights);
    for (uint32_t light = 0; light < points_.size(); ++light) {
      if (!facts.shadowless[light].empty()) continue;
      points_[light] = facts.shines_as_point(light) ? std::vector<LightPoint>{{glm::dvec2(0.0), 1.0}}
                                                    : light_points(e.scene(), light, n, pattern);
    }
    tell_left_out(e);
  }

  bool keeps_maps(const Context& c, uint32_t light) const {
    return cached_ && !c.views("views").changed[light] && !c.scene().casters_changed();
  }

  // Batch by batch: as many maps as there are layers, then the pixels' tests against them.
  void sample(Context& c, uint32_t view, uint32_t first, const std::vector<LightPoint>& all) {
    const uint32_t light = c.views("views").views[view].light;
    float total = 0;  // summed as the shader does, so that a fully lit pixel is 1
    for (const LightPoint& point : all) total += float(point.weight);
    const auto n = uint32_t(all.size());
    const uint32_t batch = cached_ ? SampleMaps::kMostLayers : maps_.layers();
    for (uint32_t at = 0; at < n; at += batch) {
      const uint32_t count = std::min(batch, n - at), layer = cached_ ? first + at : 0;
      if (!keeps_maps(c, light)) render(c, view, first + at, count, layer);
      const uint32_t part = (at == 0 ? kFirst : 0u) | (at + count == n ? kLast : 0u);
      test(c, view, {first + at, count, layer}, part, total);
    }
    samples_ += n;
  }

  struct Batch {
    uint32_t first = 0, count = 0, layer = 0;
  };
  // Without samples: nothing shadows the light's receivers.
  void test(Context& c, uint32_t view, const Batch& batch, uint32_t part, float total) {
    c.section("test");
    const AreaPush push{c.views("views").views[view].light,    view, batch.first, batch.count, batch.layer, 0,
                        {part, std::bit_cast<uint32_t>(total)}};
    c.dispatch_over(test_.ready(c, push), c.shape("visibility").extent);
    c.own_barrier();
  }

  void render(Context& c, uint32_t view, uint32_t first, uint32_t count, uint32_t layer) {
    c.section("maps");
    maps_.render(c, view, first, count, layer);
    c.own_barrier();
    rendered_ += count;
  }

  SampleMaps maps_;
  AreaShader test_;
  std::vector<std::vector<LightPoint>> points_;  // per light; none where nothing casts a shadow in view
  bool cached_ = false;
  double samples_ = 0, rendered_ = 0;
};

GNOMON_PASS("area_uniform", AreaUniform);

}  // namespace
}  // namespace gnomon
