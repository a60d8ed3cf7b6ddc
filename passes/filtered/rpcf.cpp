// The pass rpcf: percentage-closer filtering of the revectorized shadow.
#include <algorithm>
#include <string>

#include "engine/base/divide_up.h"
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/scene/scene.h"
#include "passes/frame/pixel_list.h"
#include "passes/map/map_domain.h"
#include "passes/map/receiver_ports.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

class RevectorizationBasedFilter : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Averages the revectorized shadow around every camera pixel's place in the shadow map.");
    d.cite("Macedo 2018, algorithm 2, eq. 4.1-4.2");
    const ImageShape visibility = declare_receiver(d);
    const int64_t kernel = declare_kernel(d);
    const int64_t walk =
        d.integer("max_size", 16, 1, 255, "texels", "longest walk along a silhouette, in each direction");
    const bool soft =
        d.optional_input(
             "width", Access::sampled, true,
             "of the penumbra at the receiver, world units: the kernel is then as wide as the light's "
             "larger side of that width, in whole odd texels, and 'kernel' the widest")
            .has_value();
    d.reads_around("shadow_map", uint32_t(kernel / 2 + walk + 3));
    d.flag("reuse", true, "samples share their neighbours' silhouette walks; the result is the same");
    d.flag("list", true,
           "only pixels whose kernel touches a silhouette are filtered; the result is the same");
    d.output("visibility", Access::storage_read | Access::storage_write, true, visibility,
             "0 in umbra, 1 lit; a layer a light");
    makes_shadows(d, "visibility", soft ? ShadowKind::soft : ShadowKind::filtered);
    declare_pixel_list(d, visibility.extent, "pixels whose kernel touches one light's silhouette");
  }

  void prepare(Environment& e) override {
    find_.prepare(e, "filtered/rpcf_find.glsl");
    filter_.prepare(e, "filtered/rpcf_filter.glsl",
                    {{"BLOCK", std::to_string(kBlock)}, {"ROW_SHIFT", std::to_string(kRowShift)}});
    report_bias(e);
    warn_about_kernel(e, e.shape("shadow_map").extent.width);
  }

  void record(Context& c) override {
    const ImageShape shape = c.shape("visibility");
    for (uint32_t light = 0; light < shape.layers; ++light) {
      if (find_.shade_shadowless(c, light)) continue;
      if (light > 0) c.own_barrier();  // the list is used again
      clear_pixel_list(c);
      c.own_barrier();
      find_.dispatch_over(c, light, shape.extent);
      filter(c, light);
    }
  }

 private:
  static constexpr uint32_t kBlock = 14;    // samples a side that are done together at most
  static constexpr uint32_t kRowShift = 8;  // of push.part.y: the block's bits, above which is its row

  // Block by block; without reuse row by row of each block.
  void filter(Context& c, uint32_t light) const {
    const auto kernel = uint32_t(c.params().integer("kernel"));
    const uint32_t blocks = divide_up(kernel, kBlock), size = divide_up(kernel, blocks);
    for (uint32_t y = 0; y < blocks; ++y)
      for (uint32_t x = 0; x < blocks; ++x) {
        const uint32_t rows = c.params().flag("reuse") ? 1 : std::min(kernel - y * size, size);
        for (uint32_t row = 0; row < rows; ++row) {
          c.own_barrier();
          filter_.dispatch_indirect(c, light, "arguments", {x, y | row << kRowShift});
        }
      }
  }

  PerLight find_, filter_;
};

GNOMON_PASS("rpcf", RevectorizationBasedFilter);

}  // namespace
}  // namespace gnomon
