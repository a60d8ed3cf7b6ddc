#include "engine/context.h"
#include "passes/receiver_ports.h"

namespace gnomon {
namespace {

class ShadowTest : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Tests every camera pixel against the shadow map.");
    d.cite("Williams 1978; Macedo 2018, eq. 3.2");
    const ImageShape visibility = declare_receiver(d);
    d.output("visibility", Access::storage_write, true, visibility, "0 in shadow, 1 lit; a layer a light");
  }
  void prepare(Environment& e) override {
    test_.prepare(e, "shadow_test.glsl");
    report_bias(e);
  }
  void record(Context& c) override {
    const ImageShape shape = c.shape("visibility");
    for (uint32_t light = 0; light < shape.layers; ++light) test_.dispatch_over(c, light, shape.extent);
  }

 private:
  PerLight test_;
};

GNOMON_PASS("shadow_test", ShadowTest);

}  // namespace
}  // namespace gnomon
