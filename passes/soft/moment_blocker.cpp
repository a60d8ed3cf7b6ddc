// The pass moment_blocker: what hides some of each light from each camera pixel, from averages of the shadow
// map.
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "passes/filtered/moment_basis.h"
#include "passes/filtered/summed_area.h"
#include "passes/map/listed_pixels.h"
#include "passes/map/map_traits.h"
#include "passes/map/receiver_ports.h"
#include "passes/soft/blocker_ports.h"

namespace gnomon {
namespace {

class MomentBlocker : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary(
        "Finds what hides some of the light in a summed-area table of the shadow map, without a search, and "
        "says how wide the penumbra is that it throws.");
    d.cite(
        "Macedo 2018, ch. 2.5.1; variance: Yang et al. 2010; exponential_depth: Shen et al. 2013; "
        "four_moments: Peters et al. 2017; fourier_depth: Annen et al. 2008");
    const ImageShape image = declare_receiver(d);
    d.input("pyramid", Access::sampled, true, "min_max_pyramid of the shadow map");
    read_pyramid(d, "pyramid");
    d.input("moments", Access::sampled, true, "summed_area_table of the transformed map");
    read_basis(d, "moments");
    read_table(d, "moments", true);
    refuse_without_depth(d);
    d.integer(
        "parts", 3, 1, 16, "1",
        "a side of the parts that the region is cut in, each against the receiver's plane at its middle");
    d.number("minimum_variance", 1e-6, 1e-9, 1e-2, "depth range squared", "variance: the least that counts");
    d.number("moment_bias", 1, 0, 1000, "times what rounding asks for",
             "four_moments: how much of a fixed distribution is mixed in");
    d.number("ringing", 0, 0, 16, "1", "fourier_depth: attenuation of the highest term, as a power of e");
    declare_blocker(d, image);
  }

  Need need(const SceneFacts& facts, const Params&) const override { return need_of_blocker(facts); }

  void prepare(Environment& e) override {
    const ImageShape moments = e.shape("moments");
    Defines defines = moment_defines(moments, e.shape("shadow_map").layers);
    for (auto& define : table_defines(moments, e.params())) defines.push_back(std::move(define));
    find_.prepare(e, "soft/blocker_search_find.glsl", {}, blocker_output());
    search_.prepare(e, "soft/moment_blocker.glsl", defines, blocker_output());
    report_bias(e);
  }
  void record(Context& c) override { dispatch_listed(c, find_, search_, c.shape("blocker")); }

 private:
  // Bases whose averages tell no depth of what is nearer than the receiver.
  static void refuse_without_depth(Declaration& d) {
    const std::string basis = text_trait(d, "moments", map_trait::kBasis, "variance");
    if (basis != "variance" && basis != "four_moments" && !basis.ends_with("_depth"))
      d.refuse_source("moments", "tells no depth of what hides the light: its basis is " + basis);
  }

  PerLight find_, search_;
};

GNOMON_PASS("moment_blocker", MomentBlocker);

}  // namespace
}  // namespace gnomon
