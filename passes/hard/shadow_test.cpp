// The pass shadow_test: the shadow-map test of every camera pixel.
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/scene/scene.h"
#include "passes/map/receiver_ports.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

class ShadowTest : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Tests every camera pixel against the shadow map.");
    d.cite("Williams 1978; Macedo 2018, eq. 3.2");
    const ImageShape visibility = declare_receiver(d);
    d.reads_around("shadow_map", 1);
    d.output("visibility", Access::storage_write, true, visibility, "0 in shadow, 1 lit; a layer a light");
    makes_shadows(d, "visibility", ShadowKind::hard);
  }
  void prepare(Environment& e) override {
    test_.prepare(e, "hard/shadow_test.glsl");
    report_bias(e);
  }
  void record(Context& c) override { test_.dispatch_all(c); }

 private:
  PerLight test_;
};

GNOMON_PASS("shadow_test", ShadowTest);

}  // namespace
}  // namespace gnomon
