// The pass compose: shades the G-buffer with all lights and their visibility.
#include <algorithm>
#include <string>

#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/scene/scene.h"
#include "passes/frame/behind_all.h"

namespace gnomon {
namespace {

class Compose : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.kind(PassKind::raster);
    d.summary("Shades the G-buffer with all lights and their visibility.");
    d.cite("Lambert; light falloff as in glTF's KHR_lights_punctual");
    d.optional_input("visibility", Access::sampled, true, "a layer a light; without it nothing is shadowed");
    const ImageShape depth =
        d.input("depth", Access::sampled | Access::depth_test, false, "the camera's device depth");
    d.input("normal", Access::sampled, false, "octahedral shading normal");
    d.input("albedo", Access::sampled, false, "base colour");
    d.output("color", Access::color, false, {depth.extent, 1, 1, VK_FORMAT_R16G16B16A16_SFLOAT},
             "linear radiance; black where there is no geometry");
  }
  void prepare(Environment& e) override {
    RasterState state = behind_all(e);
    state.vertex = "frame/compose.vert.glsl";
    state.fragment = "frame/compose.glsl";
    state.colors = {VK_FORMAT_R16G16B16A16_SFLOAT};
    // Every device hands 64 numbers on from vertices to fragments: 12 for the rays, 16 a light.
    constexpr size_t kFlatLights = 3;
    state.defines.emplace_back("FLAT_LIGHTS", std::to_string(std::min(e.scene().lights.size(), kFlatLights)));
    shade_ = e.raster(state);
  }
  void record(Context& c) override {
    constexpr std::array<float, 4> kBlack{0, 0, 0, 1};
    c.render({{{"color", kBlack}}, DepthTarget{"depth", {}}, {}}, [&] { c.draw_fullscreen(shade_); });
  }

 private:
  Pipeline shade_;
};

GNOMON_PASS("compose", Compose);

}  // namespace
}  // namespace gnomon
