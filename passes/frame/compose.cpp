// The pass compose: shades the G-buffer with all lights and their visibility.
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"

namespace gnomon {
namespace {

class Compose : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Shades the G-buffer with all lights and their visibility.");
    d.cite("Lambert; light falloff as in glTF's KHR_lights_punctual");
    d.optional_input("visibility", Access::sampled, true, "a layer a light; without it nothing is shadowed");
    const ImageShape depth = d.input("depth", Access::sampled, false, "the camera's device depth");
    d.input("normal", Access::sampled, false, "octahedral shading normal");
    d.input("albedo", Access::sampled, false, "base colour");
    d.output("color", Access::storage_write, false, {depth.extent, 1, 1, VK_FORMAT_R16G16B16A16_SFLOAT},
             "linear radiance; black where there is no geometry");
  }
  void prepare(Environment& e) override { pipeline_ = e.compute("frame/compose.glsl"); }
  void record(Context& c) override { c.dispatch_over(pipeline_, c.shape("color").extent); }

 private:
  Pipeline pipeline_;
};

GNOMON_PASS("compose", Compose);

}  // namespace
}  // namespace gnomon
