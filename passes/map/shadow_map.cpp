// The pass shadow_map: the scene's depth from every light.
#include <string>

#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/render_settings.h"
#include "passes/map/caster_layers.h"
#include "passes/map/map_domain.h"
#include "passes/map/map_traits.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

class ShadowMap : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.kind(PassKind::mixed);
    d.summary("Renders the scene's depth from every light, a layer a view.");
    d.cite("Williams 1978; depth encodings: Rzeczkowski 2024, eq. 3.5-3.8; midpoint: Woo 1992");
    const uint32_t size = uint32_t(d.integer("size", 1024, 1, 16384, "texels", "side of each layer"));
    const DepthMapTraits traits = declare_depth_map(d);
    const bool midpoint = traits.bias == "midpoint";
    const bool cache = d.flag("cache", false, "keep the map while no light and no caster moves");
    const BufferShape views = d.input_buffer("views", Access::uniform, "what the layers show");
    d.offer_behind("views", "depth");
    const ImageShape layers{{size, size}, uint32_t(views.count), 1, VK_FORMAT_D32_SFLOAT};
    ImageShape merged = layers;
    merged.format = VK_FORMAT_R32_SFLOAT;
    if (midpoint) {
      d.output("depth", Access::storage_write, true, merged, "depth halfway between the first two surfaces");
      d.transient("first", Access::depth | Access::sampled, true, layers, "depth of the first surface");
      d.transient("second", Access::depth | Access::sampled, true, layers, "depth of the second surface");
    } else {
      d.output("depth", Access::depth, true, layers, "depth of the first surface; 1 where there is none");
    }
    set_depth_map(d, "depth", traits);
    draws_maps(d, "depth", "size");
    if (cache) d.keep("depth");
  }

  void prepare(Environment& e) override {
    const bool linear = e.params().choice("encoding") == "linear";
    const std::string& bias = e.params().choice("bias");
    warn_about_maps(e, e.shape("depth").extent.width, MapsFrom::centre);
    midpoint_ = bias == "midpoint";
    cull_ = bias == "back_face" ? Cull::front : Cull::none;
    casters_.prepare(e, "depth");
    pipelines_ = make(e, linear, false);
    if (!midpoint_) return;
    peel_ = make(e, linear, true);
    merge_ = e.compute("map/shadow_map_midpoint.glsl");
  }

  void record(Context& c) override {
    const bool kept = casters_.update(c, c.params().flag("cache"));
    draws_ = kept ? 0 : casters_.draws();
    if (kept) return;
    const InstanceLayers& layers = casters_.of_map();
    const char* target = midpoint_ ? "first" : "depth";
    c.render({{}, DepthTarget{target, 1.0f}, {}}, [&] { c.draw_scene(pipelines_, cull_, layers); });
    if (!midpoint_) return;
    c.own_barrier();
    c.render({{}, DepthTarget{"second", 1.0f}, {}}, [&] { c.draw_scene(peel_, cull_, layers); });
    c.own_barrier();
    const ImageShape shape = c.shape("depth");
    c.dispatch_over(merge_, shape.extent, shape.layers);
  }

  std::map<std::string, double> figures() const override { return {{"draws", draws_}}; }

 private:
  // A fragment shader only where depth alone does not do. Where nothing may be left out all materials count
  // as alpha-masked.
  static ScenePipelines make(Environment& e, bool linear, bool peel) {
    RasterState state;
    state.vertex = "map/shadow_map.vert.glsl";
    state.depth = VK_FORMAT_D32_SFLOAT;
    state.depth_test = state.depth_write = true;
    state.depth_clamp = true;  // what is nearer than the view's range casts its shadow all the same
    state.depth_compare = VK_COMPARE_OP_LESS;
    if (linear) state.defines.emplace_back("LINEAR_DEPTH", "1");
    if (peel) state.defines.emplace_back("PEEL", "1");
    RasterState masked = state;
    masked.defines.emplace_back("MASKED", "1");
    masked.fragment = "map/shadow_map.glsl";
    masked.layout = VertexLayout::masked;
    if (e.settings().keep_all) return {e.raster(masked), e.raster(masked)};
    if (linear || peel)
      state.fragment = "map/shadow_map.glsl";
    else
      e.left_out("fragment shader", e.scene_facts().has_alpha_mask
                                        ? "depth alone will do for materials that are not alpha-masked"
                                        : "no material is alpha-masked");
    return {e.raster(state), e.scene_facts().has_alpha_mask ? e.raster(masked) : Pipeline{}};
  }

  CasterLayers casters_;
  double draws_ = 0;
  ScenePipelines pipelines_, peel_;
  Pipeline merge_;
  Cull cull_ = Cull::none;
  bool midpoint_ = false;
};

GNOMON_PASS("shadow_map", ShadowMap);

}  // namespace
}  // namespace gnomon
