// The pass revectorize: revectorization-based shadow mapping.
#include "engine/base/divide_up.h"
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/scene/scene.h"
#include "passes/frame/pixel_list.h"
#include "passes/map/listed_pixels.h"
#include "passes/map/receiver_ports.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

class Revectorize : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Tests every camera pixel against the shadow map and revectorizes the shadow's silhouette.");
    d.cite("Macedo 2018, eq. 3.1-3.9 and 4.1-4.2");
    const ImageShape visibility = declare_receiver(d);
    const std::string mode =
        d.choice("mode", "non_conservative", {"conservative", "non_conservative", "filtered"},
                 "visibility function: (3.6), (3.9) or (4.2)");
    d.choice(
        "walk", "tangent_plane", {"tangent_plane", "kept_lowering"},
        "depth along the walk: the receiver's tangent plane at each texel, or the remedy of section 3.1.3");
    const int64_t walk =
        d.integer("max_size", 16, 1, 1024, "texels", "longest walk along a silhouette, in each direction");
    d.reads_around("shadow_map", uint32_t(walk + 2));
    d.number("epsilon", 1e-3, 0, 1, "depth range",
             "kept_lowering: how near the map is lowered for, and by how much");
    d.output("visibility", Access::storage_write, true, visibility, "0 in shadow, 1 lit; a layer a light");
    makes_shadows(d, "visibility", mode == "filtered" ? ShadowKind::filtered : ShadowKind::hard);
    declare_pixel_list(d, visibility.extent, "pixels on one light's silhouette");
  }

  void prepare(Environment& e) override {
    find_.prepare(e, "hard/revectorize_find.glsl");
    walk_.prepare(e, "hard/revectorize_walk.glsl");
    report_bias(e);
  }

  void record(Context& c) override {
    ImageShape quads = c.shape("visibility");  // an invocation looks at 2x2 pixels
    quads.extent = {divide_up(quads.extent.width, 2), divide_up(quads.extent.height, 2)};
    dispatch_listed(c, find_, walk_, quads);
  }

 private:
  PerLight find_, walk_;
};

GNOMON_PASS("revectorize", Revectorize);

}  // namespace
}  // namespace gnomon
