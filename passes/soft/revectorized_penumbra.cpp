// The pass revectorized_penumbra: the mean of the revectorized shadow over the kernel of a penumbra's width.
#include <string>

#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "passes/frame/pixel_list.h"
#include "passes/map/listed_pixels.h"
#include "passes/map/map_traits.h"
#include "passes/map/receiver_ports.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

class RevectorizedPenumbra : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary(
        "Averages the revectorized shadow over the kernel that the light is seen through, where the penumbra "
        "is.");
    d.cite("Macedo 2018, ch. 5.3, algorithm 5, eq. 4.2, 5.4");
    const ImageShape visibility = declare_receiver(d);
    d.input("width", Access::sampled, true, "of the penumbra at the receiver, world units");
    d.input("pyramid", Access::sampled, true, "min_max_pyramid of the shadow map");
    read_pyramid(d, "pyramid");
    d.integer("taps", 7, 1, 32, "tests", "a side of the kernel");
    d.integer("max_size", 16, 1, 255, "texels", "longest walk along a silhouette, in each direction");
    d.output("visibility", Access::storage_read | Access::storage_write, true, visibility,
             "0 in umbra, 1 lit; a layer a light");
    makes_shadows(d, "visibility", ShadowKind::soft);
    declare_pixel_list(d, visibility.extent, "pixels in one light's penumbra");
  }

  void prepare(Environment& e) override {
    find_.prepare(e, "soft/revectorized_penumbra_find.glsl");
    filter_.prepare(e, "soft/revectorized_penumbra_filter.glsl", {{"MOST_TAPS", std::to_string(kMostTaps)}});
    report_bias(e);
  }

  void record(Context& c) override {
    dispatch_listed(c, find_, filter_, c.shape("visibility"), {"find", "filter"});
  }

 private:
  static constexpr int kMostTaps = 24;  // a side, that are kept as bits

  PerLight find_, filter_;
};

GNOMON_PASS("revectorized_penumbra", RevectorizedPenumbra);

}  // namespace
}  // namespace gnomon
