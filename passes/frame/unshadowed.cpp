// The pass unshadowed: visibility where nothing casts a shadow.
#include "engine/graph/pass.h"
#include "engine/graph/shadow_free.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"

namespace gnomon {
namespace {

class Unshadowed : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Visibility without shadows: 0 where the receiver faces away from the light, else 1.");
    d.cite("what every technique gives where nothing casts a shadow");
    const ImageShape depth = d.input("depth", Access::sampled, false, "the camera's device depth");
    d.input("geometric", Access::sampled, false, "octahedral geometric normal");
    d.output("visibility", Access::storage_write, true,
             {depth.extent, d.setting().lights, 1, VK_FORMAT_R32_SFLOAT},
             "0 facing away, 1 lit; a layer a light");
    d.set_trait("visibility", kShadowFree, true);
  }
  void prepare(Environment& e) override { pipeline_ = e.compute("frame/unshadowed.glsl"); }
  void record(Context& c) override {
    const ImageShape shape = c.shape("visibility");
    for (uint32_t light = 0; light < shape.layers; ++light) {
      c.push(pipeline_, light);
      c.dispatch_over(pipeline_, shape.extent);
    }
  }

 private:
  Pipeline pipeline_;
};

GNOMON_PASS("unshadowed", Unshadowed);

}  // namespace
}  // namespace gnomon
