// The pass back_projection: which points of each light the shadow map's texels hide from each camera pixel.
#include <span>
#include <string>
#include <vector>

#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/scene/scene.h"
#include "passes/frame/pixel_list.h"
#include "passes/map/listed_pixels.h"
#include "passes/map/map_traits.h"
#include "passes/map/receiver_ports.h"
#include "passes/soft/light_weights.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

constexpr uint32_t kLightWords = 1 + LightWeights::kPlanes * LightWeights::kWords;

class BackProjection : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary(
        "Projects the shadow map's texels from every camera pixel back onto the light, and tells how much of "
        "it they hide.");
    d.cite(
        "Macedo 2018, ch. 2.5.2; Guennebaud et al. 2006; bit masks: Schwarz and Stamminger 2007; "
        "silhouettes: "
        "Macedo 2018, eq. 3.9");
    const ImageShape visibility = declare_receiver(d);
    d.input("pyramid", Access::sampled, true,
            "min_max_pyramid of the shadow map: only penumbrae are worked on");
    read_pyramid(d, "pyramid");
    d.choice("overlap", "mask", {"mask", "area"},
             "patches that hide the same part of the light: it is hidden once, by a mask of 16x16 points; "
             "or as often as there are patches, as sums of areas have it");
    d.choice("silhouette", "texel", {"texel", "revectorized"},
             "patches are whole texels; or cut along the revectorized silhouette at 4x4 places of each");
    d.number("gap", 1e9, 0, 1e9, "texel widths",
             "difference of depth up to which patches beside each other are one surface, and hide what is "
             "between them; 0: none are");
    const int64_t taps = d.integer(
        "taps", 16, 4, 24, "patches",
        "a side of each of the squares around the receiver's place, a multiple of 4: the first has a "
        "patch a texel, every further one is twice as wide");
    if (taps % 4 != 0) d.refuse("taps", "a multiple of 4");
    d.transient_buffer("weights", Access::storage_read | Access::transfer_write,
                       {uint64_t(kLightWords) * d.setting().lights, 4, "uint"},
                       "of each light, the sum of its points' weights and 8 planes of their bits");
    d.keep("weights");
    d.output("visibility", Access::storage_read | Access::storage_write, true, visibility,
             "0 in umbra, 1 lit; a layer a light");
    makes_shadows(d, "visibility", ShadowKind::soft);
    declare_pixel_list(d, visibility.extent, "pixels that may see a part of one light");
  }

  void prepare(Environment& e) override {
    find_.prepare(e, "soft/back_projection_find.glsl", defines(e.params()));
    hide_.prepare(e, "soft/back_projection.glsl", defines(e.params()));
    report_bias(e);
    std::vector<uint32_t> words;
    for (uint32_t light = 0; light < e.scene_facts().lights; ++light) {
      const LightWeights weights = light_weights(e.scene(), light);
      words.push_back(weights.total);
      for (const auto& plane : weights.planes) words.insert(words.end(), plane.begin(), plane.end());
    }
    e.write("weights", std::as_bytes(std::span(words)));
  }

  void record(Context& c) override {
    dispatch_listed(c, find_, hide_, c.shape("visibility"), {"find", "hide"});
  }

 private:
  static Defines defines(const Params& params) {
    return {{"MOST_TAPS", std::to_string(params.integer("taps"))},
            {"MASK_PLANES", std::to_string(LightWeights::kPlanes)}};
  }

  PerLight find_, hide_;
};

GNOMON_PASS("back_projection", BackProjection);

}  // namespace
}  // namespace gnomon
