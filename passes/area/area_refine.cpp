// The pass area_refine: samples of each area light, refined level by level of a quad-tree.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

#include "engine/base/divide_up.h"
#include "engine/base/error.h"
#include "engine/graph/pass.h"
#include "engine/light/light_view.h"
#include "engine/light/scene_facts.h"
#include "engine/light/view_set.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/gpu_scene.h"
#include "engine/scene/area_light.h"
#include "engine/scene/scene.h"
#include "engine/vulkan/occlusion_queries.h"
#include "passes/area/area_light_points.h"
#include "passes/area/area_words.h"
#include "passes/area/map_cache.h"
#include "passes/area/sample_maps.h"
#include "passes/frame/pixel_list.h"

namespace gnomon {
namespace {

uint32_t most_samples(int64_t levels) {
  const uint32_t side = (1u << levels) + 1;
  return side * side;
}

uint32_t most_questions(int64_t levels) { return levels == 0 ? 1 : 1u << (2 * (levels - 1)); }

// One light's samples, and where they are among all.
struct LightState {
  uint32_t first = 0, capacity = 0;  // slots; `first` is a multiple of kWordSamples
  std::vector<uint32_t> views;
  std::optional<LightQuads> tree;  // none: the light is a point
  uint32_t rendered = 0;           // samples whose maps have been rendered
  bool needed = true;              // some caster's shadow can be in view
  bool area = false;               // wide enough for penumbrae
  bool holds_all = false;          // capacity for all samples that there can be
  bool full = false;               // a quad stayed whole because memory for samples ran out
};

class AreaRefine : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.kind(PassKind::mixed);
    d.summary(
        "Refines the samples of each area light, level by level of a quad-tree, until the camera sees no "
        "banding.");
    d.cite("Schwaerzler et al. 2012; Macedo 2018, ch. 6.1.1, algorithm 6, eq. 6.1-6.3, 6.6-6.7");
    const int64_t levels =
        d.integer("levels", 4, 0, 5, "1", "how often the light's rectangle may be divided");
    d.choice(
        "test", "rbsm", {"rbsm", "rpcf", "pcf"},
        "a sample's visibility: filtered RBSM, RPCF 2x2, or PCF 2x2 (then without soft discontinuities)");
    d.integer("soft_discontinuity", 2, 0, 4, "samples",
              "of a quad's four, on whose silhouettes a pixel is smooth");
    d.integer("max_size", 16, 1, 255, "texels", "longest walk along a silhouette, in each direction");
    for (const auto& [name, factor, help] :
         {std::tuple{"window_1", 1, "quads of level 0: every n-th pixel is asked"},
          std::tuple{"window_2", 2, "the same for levels 1 and 2"},
          std::tuple{"window_4", 4, "the same for further levels"}})
      d.integer(name, factor, 1, 31, "pixels", help);
    d.choice("order", "breadth_first", {"breadth_first", "depth_first"},
             "a level's quads together, or one by one as in the paper; the samples are the same");
    d.choice("weights", "area", {"area", "leaf", "creation"},
             "of the samples: their leaves' areas, or (6.5) by the finest leaf or by the level of creation");
    const uint32_t wanted = d.setting().lights * divide_up(most_samples(levels), kWordSamples) * kWordSamples;
    const bool cache =
        d.flag("cache", false, "maps of unchanged lights and casters stay from frame to frame");
    constexpr double kShare = 0.25;  // of the memory limit: area_words.cpp takes the rest
    const uint32_t views = SampleMaps::declare_views(d);
    const ImageShape visibility = SampleMaps::declare(d, cache ? wanted : kWordSamples, cache, kShare);
    const uint32_t slots = declare_sample_outputs(d, visibility.extent, wanted);
    SampleMaps::declare_samples(d, views, uint64_t(slots) * views);
    d.output_buffer("answers", Access::transfer_write | Access::host_read,
                    {uint64_t(2) * d.setting().lights * most_questions(levels), 4, "uint"},
                    "of each quad asked about: pixels with banding, and whether the query was answered");
    d.transient("window", Access::color, false,
                {{divide_up(visibility.extent.width, kWordSamples), visibility.extent.height},
                 1,
                 1,
                 VK_FORMAT_R8_UNORM},
                "what the queries are drawn over; nothing is written");
    declare_pixel_list(d, visibility.extent, "pixels on a silhouette of the samples at hand");
  }

  void prepare(Environment& e) override {
    const Params& p = e.params();
    find_.prepare(e, "area/area_refine_find.glsl", {{"PART_NO_CASTERS", std::to_string(kNoCasters)}});
    walk_.prepare(e, "area/area_refine_walk.glsl");
    transpose_ = e.compute("area/area_refine_transpose.glsl");
    RasterState state;
    state.vertex = "frame/fullscreen.vert.glsl";
    state.fragment = "area/area_refine_quad.glsl";
    state.layout = VertexLayout::none;
    state.colors = {VK_FORMAT_R8_UNORM};
    state.color_write = false;
    quad_ = e.raster(state);
    const uint32_t lights = uint32_t(e.scene().lights.size());
    queries_ = e.occlusion_queries(lights * most_questions(p.integer("levels")));
    place_lights(e);
    maps_.prepare(e);
    batch_ = std::min(maps_.layers(), kWordSamples);
    cache_.resize(maps_.layers(), p.flag("cache") ? batch_ : maps_.layers());
    if (p.flag("cache") && maps_.layers() <= batch_)
      e.warn("cache: the memory limit leaves no room for kept maps");
    weights_kind_ = SampleWeights(p.choice_index("weights"));
    order_ = QuadOrder(p.choice_index("order"));
    windows_ = {uint32_t(p.integer("window_1")), uint32_t(p.integer("window_2")),
                uint32_t(p.integer("window_4"))};
  }

  void record(Context& c) override {
    if (c.iteration() == 0) begin(c);
    for (uint32_t light = 0; light < lights_.size(); ++light) sample(c, light);
    ask(c);
    ++turns_;
  }

  Step decide(const HostView& host) override {
    std::vector<uint32_t> answers(2 * asked_);
    if (asked_ > 0)
      std::memcpy(answers.data(), host.buffer("answers").data(), answers.size() * sizeof(uint32_t));
    const std::vector<bool> banding = any_passed(answers);
    size_t next = 0;
    bool more = false;
    for (LightState& light : lights_) {
      if (!light.tree) continue;
      light.tree->answer(divided(light, banding, next));
      more = more || !light.tree->questions().empty() || light.tree->samples().size() > light.rendered;
    }
    if (more) return Step::again;
    finish(host);
    return Step::done;
  }

  std::map<std::string, double> figures() const override {
    double samples = 0, level = 0, full = 0;
    for (const LightState& light : lights_) {
      samples += light.needed ? light.rendered : 0;
      if (light.tree) level = std::max(level, double(light.tree->deepest_level()));
      full += light.full ? 1 : 0;
    }
    return {{"light_samples", samples},
            {"levels", level},
            {"host_waits", turns_},
            {"maps_rendered", maps_rendered_},
            {"lights_cut_by_memory", full}};
  }

 private:
  static constexpr uint32_t kNoCasters = 1;  // a push: there are no maps

  // Slots: area lights share what there is; a point takes one word.
  void place_lights(Environment& e) {
    const Scene& scene = e.scene();
    lights_.resize(scene.lights.size());
    const auto& views = e.views("views").views;
    for (uint32_t i = 0; i < views.size(); ++i) lights_[views[i].light].views.push_back(i);
    slots_ = e.shape("values").layers;
    const SceneFacts& facts = e.scene_facts();
    uint32_t areas = 0;
    for (uint32_t i = 0; i < lights_.size(); ++i) {
      lights_[i].needed = facts.shadowless[i].empty();
      lights_[i].area = shines_as_area(scene.lights[i]) && !facts.shines_as_point(i);
      areas += lights_[i].area ? 1 : 0;
    }
    tell_left_out(e);
    const uint32_t points = uint32_t(scene.lights.size()) - areas, words = slots_ / kWordSamples;
    if (words < points + areas)
      fail(fmt::format("{} lights at this size need more memory than the limit", scene.lights.size()), {},
           e.id(), "raise --memory or render a smaller image");
    const uint32_t share = areas > 0 ? (words - points) / areas : 0;
    const uint32_t most = most_samples(e.params().integer("levels"));
    uint32_t first = 0;
    for (uint32_t i = 0; i < lights_.size(); ++i) {
      lights_[i].first = first;
      lights_[i].capacity = lights_[i].area ? std::min(share * kWordSamples, most) : 1;
      lights_[i].holds_all = lights_[i].capacity == most;
      first += divide_up(lights_[i].capacity, kWordSamples) * kWordSamples;
    }
  }

  void begin(Context& c) {
    maps_.begin(c);
    turns_ = maps_rendered_ = 0;
    const ViewSet& set = c.views("views");
    for (uint32_t view = 0; view < set.views.size(); ++view)
      if (set.changed[set.views[view].light]) cache_.forget(view);
    if (c.scene().casters_changed()) cache_.forget();
    const Scene& scene = c.scene().scene();
    for (uint32_t i = 0; i < lights_.size(); ++i) {
      LightState& light = lights_[i];
      light.rendered = 0;
      light.full = false;
      light.tree.reset();
      if (light.needed && light.area)
        light.tree.emplace(uint32_t(c.params().integer("levels")), order_, light_surface(scene, i));
      if (light.tree && light.tree->samples().empty())
        light.tree.reset();  // no point of the grid is on it: its centre
    }
  }

  // --- an iteration: new samples ---

  void sample(Context& c, uint32_t index) {
    LightState& light = lights_[index];
    const uint32_t count = light.tree ? uint32_t(light.tree->samples().size()) : 1;
    const uint32_t from = light.rendered;
    for (uint32_t at = from; at < count;) {
      const uint32_t bit = at % kWordSamples;
      const uint32_t batch = std::min({count - at, kWordSamples - bit, batch_});
      for (const uint32_t view : light.views) evaluate(c, index, view, at, batch);
      at += batch;
    }
    light.rendered = count;
  }

  // Where a view's sample is in the buffer of samples.
  uint32_t sample_index(const LightState& light, uint32_t view, uint32_t sample) const {
    const auto which =
        uint32_t(std::find(light.views.begin(), light.views.end(), view) - light.views.begin());
    return which * slots_ + light.first + sample;
  }

  // Where samples [at, at + count) are on the light, local.
  static std::vector<glm::dvec2> places(const Context& c, const LightState& light, uint32_t view, uint32_t at,
                                        uint32_t count) {
    if (!light.tree) return {glm::dvec2(0.0)};
    const AreaLight& area = *c.scene().scene().lights[c.views("views").views[view].light].area;
    std::vector<glm::dvec2> places;
    for (uint32_t i = at; i < at + count; ++i) places.push_back(place_on(area, light.tree->samples()[i]));
    return places;
  }

  // Those maps that are not there yet.
  void render(Context& c, const LightState& light, uint32_t view, uint32_t at, uint32_t count) {
    const std::vector<glm::dvec2> locals = places(c, light, view, at, count);
    const MapCache::Placed placed = cache_.place(view, locals);
    std::vector<LightPoint> points;
    for (size_t i = 0; i < locals.size(); ++i) points.push_back({locals[i], 1.0, placed.layers[i]});
    const uint32_t first = sample_index(light, view, at);
    maps_.write(c, view, first, points);
    for (const MapCache::Run& run : placed.missing) {
      maps_.render(c, view, first + run.first, run.count, run.layer);
      maps_rendered_ += run.count;
    }
  }

  // Maps of up to a word's samples, and all that is kept of them.
  void evaluate(Context& c, uint32_t index, uint32_t view, uint32_t at, uint32_t count) {
    const LightState& light = lights_[index];
    const uint32_t first = sample_index(light, view, at), slot = light.first + at;
    const uint32_t word = slot / kWordSamples, bit = slot % kWordSamples;
    c.section("maps");
    if (light.needed) render(c, light, view, at, count);
    clear_pixel_list(c);
    c.own_barrier();
    c.section("discontinuities");
    const AreaPush push{index, view, first, count, 0, bit, {word, light.needed ? 0u : kNoCasters}};
    c.dispatch_over(find_.ready(c, push), pixels(c));
    c.own_barrier();
    c.section("revectorize");
    c.dispatch_indirect(walk_.ready(c, push), "arguments");
    c.section("discontinuities");
    c.push(transpose_, std::array<uint32_t, 3>{word, bit, count});
    c.dispatch_over(transpose_, {divide_up(pixels(c).width, kWordSamples), pixels(c).height});
    c.own_barrier();
  }

  static Extent pixels(const Context& c) { return c.shape("depth").extent; }

  // --- an iteration: questions ---

  struct QuadPush {
    std::array<uint32_t, 4> slots;
    uint32_t stride;
  };

  void ask(Context& c) {
    c.section("queries");
    c.reset(queries_);
    asked_ = 0;
    for (const LightState& light : lights_)
      if (light.tree)
        for (const LightQuads::Quad& quad : light.tree->questions()) ask(c, light, quad);
    if (asked_ > 0) c.results(queries_, asked_, "answers");
  }

  void ask(Context& c, const LightState& light, const LightQuads::Quad& quad) {
    const uint32_t stride = windows_[std::min<uint32_t>((quad.level + 1) / 2, 2)];
    QuadPush push{{}, stride};
    for (size_t i = 0; i < 4; ++i) push.slots[i] = light.first + quad.samples[i];
    c.render({{ColorTarget{"window", {}}}, {}, {}}, [&] {
      c.bind(quad_);  // lavapipe begins no query without a pipeline
      c.push(quad_, push);
      c.set_area({divide_up(pixels(c).width, kWordSamples), divide_up(pixels(c).height, stride)});
      c.query(queries_, asked_, [&] { c.draw_fullscreen(quad_); });
    });
    ++asked_;
  }

  // One light's answers, from `next` on.
  std::vector<bool> divided(LightState& light, const std::vector<bool>& banding, size_t& next) const {
    std::vector<bool> divide;
    uint32_t room = light.capacity - uint32_t(light.tree->samples().size());
    constexpr uint32_t kMostNew = 5;  // samples that dividing a quad makes
    for (size_t i = 0; i < light.tree->questions().size(); ++i, ++next) {
      const bool fits = light.holds_all || room >= kMostNew;
      light.full = light.full || (banding[next] && !fits);
      divide.push_back(banding[next] && fits);
      if (divide.back()) room -= std::min(room, kMostNew);
    }
    return divide;
  }

  // --- the end ---

  void finish(const HostView& host) {
    const auto ranges = host.writable("sample_ranges"), weights = host.writable("weights");
    auto* range = reinterpret_cast<uint32_t*>(ranges.data());
    auto* weight = reinterpret_cast<float*>(weights.data());
    for (const LightState& light : lights_) {
      *range++ = light.first;
      *range++ = light.rendered;
      const std::vector<double> all =
          light.tree ? light.tree->weights(weights_kind_) : std::vector<double>{1.0};
      std::copy(all.begin(), all.end(), weight + light.first);
    }
  }

  SampleMaps maps_;
  AreaShader find_, walk_;
  Pipeline transpose_, quad_;
  OcclusionQueries queries_;
  std::vector<LightState> lights_;
  std::array<uint32_t, 3> windows_{};
  SampleWeights weights_kind_ = SampleWeights::area;
  QuadOrder order_ = QuadOrder::breadth_first;
  MapCache cache_;
  uint32_t slots_ = 0, asked_ = 0, batch_ = 0;  // batch: samples at a time
  double turns_ = 0, maps_rendered_ = 0;
};

GNOMON_PASS("area_refine", AreaRefine);

}  // namespace
}  // namespace gnomon
