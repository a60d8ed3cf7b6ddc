// The pass silhouette_penumbra: penumbrae of a light's own size from the distance to the hard shadow's
// silhouette.
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "passes/distance/distance_transform_ports.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

class SilhouettePenumbra : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary(
        "Turns the distance to the hard shadow's silhouette into the penumbra of what hides the light "
        "there.");
    d.cite("Macedo 2018, ch. 5.4, algorithm 4, eq. 5.2-5.3");
    distance_transform::declare_units(d);
    d.input("nearest", Access::sampled, true, "nearest silhouette pixel, as distance_transform gives it");
    const ImageShape hard = d.input("source", Access::sampled, true, "hard shadow; a layer a light");
    d.input("blocker", Access::sampled, true,
            "linear depth of what hides some of the light, from it; 0: nothing");
    d.input("depth", Access::sampled, false, "the camera's device depth");
    d.input("geometric", Access::sampled, false, "octahedral geometric normal");
    d.input_behind("views", "source", Access::uniform, "what the shadow map's layers show");
    d.offer_behind("source", "visibility");
    d.number("depth_tolerance", 1e-3, 0, 1, "of the view depth",
             "distance from the receiver's tangent plane within which a silhouette pixel is on its surface");
    d.number("bend", 0.25, 0, 1, "1", "further such distance, per distance between the two");
    d.output("visibility", Access::storage_write, true, hard, "0 in umbra, 1 lit; a layer a light");
    makes_shadows(d, "visibility", ShadowKind::soft);
  }
  void prepare(Environment& e) override { shade_ = e.compute("soft/silhouette_penumbra.glsl"); }
  void record(Context& c) override {
    const ImageShape shape = c.shape("visibility");
    c.dispatch_over(shade_, shape.extent, shape.layers);
  }

 private:
  Pipeline shade_;
};

GNOMON_PASS("silhouette_penumbra", SilhouettePenumbra);

}  // namespace
}  // namespace gnomon
