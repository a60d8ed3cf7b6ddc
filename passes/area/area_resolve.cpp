// The pass area_resolve: weighs the refined samples where the camera sees penumbra.
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "passes/area/area_words.h"
#include "passes/frame/pixel_list.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

class AreaResolve : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Weighs the samples of area lights that were refined, where the camera sees penumbra.");
    d.cite("Macedo 2018, ch. 6.1.2, algorithm 6, eq. 6.2-6.4");
    const Extent pixels = declare_sample_inputs(d);
    d.output("visibility", Access::storage_write, true, {pixels, d.setting().lights, 1, VK_FORMAT_R32_SFLOAT},
             "0 in umbra, 1 lit; a layer a light");
    makes_shadows(d, "visibility", ShadowKind::soft);
    d.output("labels", Access::storage_write, true, {pixels, d.setting().lights, 1, VK_FORMAT_R8_UNORM},
             "visibility map: 0 umbra, 1/2 penumbra, 1 lit; a layer a light");
    declare_pixel_list(d, pixels, "pixels in one light's penumbra");
  }

  void prepare(Environment& e) override {
    classify_ = e.compute("area/area_resolve.glsl");
    shade_ = e.compute("area/area_resolve_shade.glsl");
  }

  void record(Context& c) override {
    const ImageShape shape = c.shape("visibility");
    for (uint32_t light = 0; light < shape.layers; ++light) {
      clear_pixel_list(c);
      c.own_barrier();
      c.push(classify_, light);
      c.dispatch_over(classify_, shape.extent);
      c.own_barrier();
      c.dispatch_indirect(shade_, "arguments");
      c.own_barrier();  // the list is used again
    }
  }

 private:
  Pipeline classify_, shade_;
};

GNOMON_PASS("area_resolve", AreaResolve);

}  // namespace
}  // namespace gnomon
