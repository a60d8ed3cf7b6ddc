// The pass visibility_blur: the mean of the visibility over a square of pixels.
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"

namespace {

using namespace gnomon;

class VisibilityBlur : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Means the visibility over a square of pixels.");
    const ImageShape source = d.input("source", Access::sampled, true, "visibility; a layer a light");
    d.integer("radius", 2, 0, 16, "pixels", "half the side of the square");
    d.output("visibility", Access::storage_write, true, source, "the mean");
  }
  Need need(const SceneFacts&, const Params& params) const override {
    if (params.integer("radius") > 0) return Need::run();
    return Need::bypass("visibility", "source", "the radius is 0");
  }
  // A shader outside of Gnomon's own folder is named by its absolute path.
  void prepare(Environment& e) override { pipeline_ = e.compute(OWN_FOLDER "/visibility_blur.glsl"); }
  void record(Context& c) override {
    const ImageShape shape = c.shape("visibility");
    c.dispatch_over(pipeline_, shape.extent, shape.layers);
  }

 private:
  Pipeline pipeline_;
};

GNOMON_PASS("visibility_blur", VisibilityBlur);

}  // namespace
