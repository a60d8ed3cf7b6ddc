// The pass shadow_moments: transforms a shadow map's depth to a technique's basis.
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "passes/filtered/moment_basis.h"
#include "passes/map/map_traits.h"

namespace gnomon {
namespace {

class ShadowMoments : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary(
        "Transforms a shadow map's depth to the basis of a technique "
        "whose map can be filtered.");
    d.cite(
        "Donnelly and Lauritzen 2006; Annen et al. 2007; Annen et al. 2008; "
        "Lauritzen and McCool 2008; Peters and "
        "Klein 2015; Peters et al. 2017");
    const ImageShape map =
        d.input("shadow_map", Access::sampled, true, "depth from the light, a layer a view");
    d.input_behind("views", "shadow_map", Access::uniform, "what the map's layers show");
    d.reads_around("shadow_map", 0, "moments");
    read_encoding(d, "shadow_map");
    const MomentLayout layout = declare_basis(d);
    d.output("moments", Access::storage_write, true,
             {map.extent, map.layers * layout.layers, 1, layout.format},
             "the basis of every texel's depth; a view's layers follow each other");
    d.carry_traits("shadow_map", "moments");
    set_basis(d, "moments");
  }
  void prepare(Environment& e) override {
    transform_ = e.compute("filtered/shadow_moments.glsl",
                           moment_defines(e.shape("moments"), e.shape("shadow_map").layers));
  }
  void record(Context& c) override {
    const ImageShape map = c.shape("shadow_map");
    c.dispatch_over(transform_, map.extent, map.layers);
  }

 private:
  Pipeline transform_;
};

GNOMON_PASS("shadow_moments", ShadowMoments);

}  // namespace
}  // namespace gnomon
