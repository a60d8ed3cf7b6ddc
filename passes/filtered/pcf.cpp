// The pass pcf: percentage-closer filtering.
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/render_settings.h"
#include "engine/scene/scene.h"
#include "passes/map/map_domain.h"
#include "passes/map/map_traits.h"
#include "passes/map/min_max_map.h"
#include "passes/map/receiver_ports.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

class PercentageCloserFilter : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Averages the shadow tests around every camera pixel's place in the shadow map.");
    d.cite("Reeves, Salesin and Cook 1987; Macedo 2018, ch. 2.4; with a width: Fernando 2005");
    const ImageShape visibility = declare_receiver(d);
    const int64_t kernel = declare_kernel(d);
    const bool soft = d.optional_input("width", Access::sampled, true,
                                       "of the penumbra at the receiver, world units: the kernel is then the "
                                       "light's shape of that width, whatever 'kernel' says")
                          .has_value();
    d.optional_input(
        "pyramid", Access::sampled, true,
        "with 'width': min_max_pyramid of the shadow map, so that only penumbrae are filtered; the "
        "result is the same");
    read_pyramid(d, "pyramid");
    d.integer(
        "taps", 16, 1, 64, "tests",
        "with 'width': a side of the kernel at most; when it has fewer texels, each is one test and those "
        "of its border weigh in part");
    if (!soft) d.reads_around("shadow_map", uint32_t(kernel / 2 + 2));
    d.choice(
        "sampling", "box", {"box", "smooth_box", "vogel"},
        "box of whole texels; box about the receiver's exact place, whose border texels weigh in part; or "
        "Vogel's spiral over a disc");
    d.integer("samples", 32, 1, 1024, "samples", "vogel: tests a pixel");
    d.flag("rotate", true, "vogel: turn the spiral from pixel to pixel, which makes bands into noise");
    const bool min_max = d.flag("min_max", false,
                                "filter only where a min-max map does not tell that all of the window is lit "
                                "or in umbra; the result is the same");
    if (min_max) MinMaxMap::declare(d, d.find("shadow_map")->image);
    d.output("visibility", Access::storage_write, true, visibility, "0 in umbra, 1 lit; a layer a light");
    makes_shadows(d, "visibility", soft ? ShadowKind::soft : ShadowKind::filtered);
  }
  void prepare(Environment& e) override {
    const bool soft = e.connected("width");
    min_max_ = e.params().flag("min_max") && !e.settings().keep_all && !soft;
    filter_.prepare(e, soft ? "filtered/pcf_soft.glsl" : "filtered/pcf.glsl",
                    {{"USE_MIN_MAX", min_max_ ? "1" : "0"}});
    if (min_max_) map_.prepare(e, uint32_t(e.params().integer("kernel")) / 2 + 1);
    report_bias(e);
    if (!soft) warn_about_kernel(e, e.shape("shadow_map").extent.width);
  }
  void record(Context& c) override {
    if (min_max_) map_.record(c);
    filter_.dispatch_all(c);
  }

 private:
  MinMaxMap map_;
  bool min_max_ = false;
  PerLight filter_;
};

GNOMON_PASS("pcf", PercentageCloserFilter);

}  // namespace
}  // namespace gnomon
