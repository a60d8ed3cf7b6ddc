// The pass screen_blocker_search: what hides some of each light from each camera pixel, found on the screen.
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "passes/map/listed_pixels.h"
#include "passes/map/map_traits.h"
#include "passes/map/receiver_ports.h"
#include "passes/screen/screen_kernel.h"
#include "passes/soft/blocker_ports.h"

namespace gnomon {
namespace {

class ScreenBlockerSearch : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary(
        "Projects the shadow map to the screen and searches there for what hides some of the light, and says "
        "how wide the penumbra is that it throws.");
    d.cite("MohammadBagher et al. 2010; Macedo 2018, ch. 2.5.4");
    const ImageShape image = declare_receiver(d);
    declare_surface_test(d);
    d.integer("taps", 8, 1, 64, "pixels", "a side of the region; when it has fewer, each is one");
    d.input("pyramid", Access::sampled, true, "min_max_pyramid of the shadow map");
    read_pyramid(d, "pyramid");
    d.transient("occluder", Access::storage_read | Access::storage_write, true, image,
                "linear depth of what hides the pixel from the light's centre; 0: nothing does");
    declare_blocker(d, image);
  }

  Need need(const SceneFacts& facts, const Params&) const override { return need_of_blocker(facts); }

  void prepare(Environment& e) override {
    project_.prepare(e, "soft/screen_blockers_project.glsl", {}, blocker_output());
    find_.prepare(e, "soft/blocker_search_find.glsl", {}, blocker_output());
    search_.prepare(e, "soft/screen_blocker_search.glsl", {}, blocker_output());
    report_bias(e);
  }
  void record(Context& c) override {
    project_.dispatch_all(c);
    dispatch_listed(c, find_, search_, c.shape("blocker"));
  }

 private:
  PerLight project_, find_, search_;
};

GNOMON_PASS("screen_blocker_search", ScreenBlockerSearch);

}  // namespace
}  // namespace gnomon
