// The pass pcf: percentage-closer filtering.
#include <algorithm>
#include <span>

#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/render_settings.h"
#include "engine/scene/scene.h"
#include "passes/frame/pixel_list.h"
#include "passes/map/listed_pixels.h"
#include "passes/map/map_domain.h"
#include "passes/map/map_traits.h"
#include "passes/map/min_max_map.h"
#include "passes/map/receiver_ports.h"
#include "passes/soft/light_cells.h"
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
    d.number("narrowest", 0, 0, 16, "texels",
             "with 'width': least width of a kernel; below 1.5 the map's own steps show");
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
    if (soft) declare_soft(d, visibility);
    d.output("visibility", Access::storage_write, true, visibility, "0 in umbra, 1 lit; a layer a light");
    makes_shadows(d, "visibility", soft ? ShadowKind::soft : ShadowKind::filtered);
  }
  void prepare(Environment& e) override {
    const bool soft = e.connected("width");
    min_max_ = e.params().flag("min_max") && !e.settings().keep_all && !soft;
    soft_ = soft;
    if (soft)
      prepare_soft(e);
    else
      filter_.prepare(e, "filtered/pcf.glsl", {{"USE_MIN_MAX", min_max_ ? "1" : "0"}});
    if (min_max_) map_.prepare(e, uint32_t(e.params().integer("kernel")) / 2 + 1);
    report_bias(e);
    if (!soft) warn_about_kernel(e, e.shape("shadow_map").extent.width);
  }
  void record(Context& c) override {
    if (soft_) return dispatch_listed(c, find_, filter_, c.shape("visibility"));
    if (min_max_) map_.record(c);
    filter_.dispatch_all(c);
  }

 private:
  static void declare_soft(Declaration& d, const ImageShape& visibility) {
    declare_pixel_list(d, visibility.extent, "pixels whose kernel is neither all lit nor all in umbra");
    const uint64_t cells = uint64_t(d.setting().lights) * kLightCells * kLightCells;
    d.transient_buffer("cells", Access::storage_read | Access::transfer_write, {cells, 4, "float"},
                       "how much each part of each light counts (passes/soft/light_cells.h)");
    d.keep("cells");
  }

  void prepare_soft(Environment& e) {
    const auto& lights = e.scene().lights;
    std::vector<float> cells;
    for (const Light& light : lights)
      for (const float cell : light_cells(e.scene(), light)) cells.push_back(cell);
    e.write("cells", std::as_bytes(std::span(cells)));
    const bool uneven = std::any_of(lights.begin(), lights.end(), has_uneven_cells);
    filter_.prepare(e, "filtered/pcf_soft.glsl",
                    {{"UNEVEN", uneven ? "1" : "0"}, {"CELLS", std::to_string(kLightCells)}});
    find_.prepare(e, "filtered/soft_find.glsl", {{"PLAIN_DECIDES", "0"}});
  }

  MinMaxMap map_;
  bool min_max_ = false, soft_ = false;
  PerLight find_, filter_;
};

GNOMON_PASS("pcf", PercentageCloserFilter);

}  // namespace
}  // namespace gnomon
