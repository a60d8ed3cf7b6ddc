// The pass distance_penumbra: turns the distance to the hard shadow's silhouette into penumbra.
#include <limits>

#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/scene/scene.h"
#include "passes/distance/distance_transform_ports.h"
#include "passes/distance/penumbra_width.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

constexpr double kWidestPenumbra = 0.05;  // of the scene's diagonal

class DistancePenumbra : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Turns the distance to the hard shadow's silhouette into penumbra.");
    d.cite("Macedo 2018, eq. 4.3; Macedo and Apolinario 2017, eq. 1");
    distance_transform::declare_units(d);
    d.input("nearest", Access::sampled, true, "nearest silhouette pixel, as distance_transform gives it");
    d.input_buffer("tiles", Access::storage_read,
                   "tiles of 16x16 pixels that have silhouette pixels in reach");
    d.input_buffer("arguments", Access::storage_read | Access::indirect,
                   "workgroups (x, y, z) and number of tiles");
    d.input("depth", Access::sampled, false, "the camera's device depth");
    d.input("geometric", Access::sampled, false, "octahedral geometric normal");
    read_penumbra_traits(d, "nearest");
    const bool soft =
        d.optional_input(
             "width", Access::sampled, true,
             "of the penumbra at each pixel, world units, instead of one for all: a silhouette pixel's "
             "counts for those that it is nearest to (world metric)")
            .has_value();
    const bool screen = d.choice("metric", "world", {"world", "screen"},
                                 "distances in the world or in the image") == "screen";
    const Value* pixels = d.trait("nearest", "pixels");
    if (screen && pixels && std::get<double>(*pixels) < 1)
      d.refuse_source("nearest", "was made for a penumbra without a width in pixels");
    d.number("bend", 0.25, 0, 1, "1", "further such distance, per distance between the two");
    d.inout("visibility", Access::storage_read | Access::storage_write, true,
            "in: hard shadow; out: 0 in umbra, 1 lit; a layer a light");
    d.optional_input_behind("views", "visibility", Access::uniform, "what the shadow map's layers show");
    makes_shadows(d, "visibility", soft ? ShadowKind::soft : ShadowKind::filtered);
  }
  void prepare(Environment& e) override {
    shade_ = e.compute("distance/distance_penumbra.glsl");
    // Not zero: the penumbra of a width that no pixel sees is a step.
    width_ = std::max(float(penumbra_width(e.scene(), e.params())), std::numeric_limits<float>::min());
    e.fact("penumbra_world", width_);
    const double diagonal = 2.0 * e.scene().bounds.radius();
    if (e.params().choice("metric") == "world" && !e.connected("width") &&
        width_ > kWidestPenumbra * diagonal)
      e.warn("a penumbra this wide, more than a twentieth of the scene's diagonal, dissolves shadows");
  }
  void record(Context& c) override {
    c.bind(shade_);
    c.push(shade_, width_);
    c.dispatch_indirect(shade_, "arguments");
  }

 private:
  Pipeline shade_;
  float width_ = 1;
};

GNOMON_PASS("distance_penumbra", DistancePenumbra);

}  // namespace
}  // namespace gnomon
