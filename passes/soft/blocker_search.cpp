// The pass blocker_search: what hides some of each light from each camera pixel, found in the shadow map.
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "passes/map/listed_pixels.h"
#include "passes/map/map_traits.h"
#include "passes/map/receiver_ports.h"
#include "passes/soft/blocker_ports.h"

namespace gnomon {
namespace {

class BlockerSearch : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary(
        "Searches the shadow map for what hides some of the light, and says how wide the penumbra is that it "
        "throws.");
    d.cite("Fernando 2005; Macedo 2018, ch. 2.5.1, eq. 5.1-5.2, and algorithm 5 (the pyramid)");
    const ImageShape image = declare_receiver(d);
    const bool exact =
        d.choice(
            "protocol", "exact", {"exact", "thesis"},
            "exact: the region that the light's size asks for, shrunk to that of the nearest depth in it; "
            "thesis: that of blockers on the near plane, as it is (Macedo 2018, ch. 5.5.1)") == "exact";
    d.integer("taps", 9, 1, 64, "taps", "a side of the region; when it has fewer texels, each is one");
    const std::string pyramid = "exact: min_max_pyramid of the shadow map";
    if (exact)
      d.input("pyramid", Access::sampled, true, pyramid);
    else
      d.optional_input("pyramid", Access::sampled, true, pyramid);
    read_pyramid(d, "pyramid");
    declare_blocker(d, image);
  }

  Need need(const SceneFacts& facts, const Params&) const override { return need_of_blocker(facts); }

  void prepare(Environment& e) override {
    find_.prepare(e, "soft/blocker_search_find.glsl", {}, blocker_output());
    search_.prepare(e, "soft/blocker_search.glsl", {}, blocker_output());
    report_bias(e);
  }
  void record(Context& c) override { dispatch_listed(c, find_, search_, c.shape("blocker")); }

 private:
  PerLight find_, search_;
};

GNOMON_PASS("blocker_search", BlockerSearch);

}  // namespace
}  // namespace gnomon
