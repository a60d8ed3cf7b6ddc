// The pass compose: shades the G-buffer with all lights and their visibility.
#include <algorithm>
#include <string>

#include "engine/graph/pass.h"
#include "engine/light/ambient.h"
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
    const Ambient standard;
    d.number(
        "ambient", standard.share, 0, 10, "1",
        "irradiance from the sky, as a share of what all lights bring to the scene's middle; 0: none, and "
        "the background is black");
    d.number("ground", standard.ground, 0, 1, "1", "radiance of the ground, as a share of the sky's");
    d.number("sky_red", standard.sky.r, 0, 1, "1", "colour of the sky, linear, as the two below");
    d.number("sky_green", standard.sky.g, 0, 1, "1", "see sky_red");
    d.number("sky_blue", standard.sky.b, 0, 1, "1", "see sky_red");
    d.output("color", Access::color, false, {depth.extent, 1, 1, VK_FORMAT_R16G16B16A16_SFLOAT},
             "linear radiance; the sky's where there is no geometry");
  }
  void prepare(Environment& e) override {
    RasterState state = behind_all(e);
    state.vertex = "frame/compose.vert.glsl";
    state.fragment = "frame/compose.glsl";
    state.colors = {VK_FORMAT_R16G16B16A16_SFLOAT};
    // Every device hands 64 numbers on from vertices to fragments: 12 for the rays, 16 a light.
    constexpr size_t kFlatLights = 3;
    state.defines.emplace_back("FLAT_LIGHTS", std::to_string(std::min(e.scene().lights.size(), kFlatLights)));
    const Params& p = e.params();
    const Ambient ambient{p.number("ambient"),
                          p.number("ground"),
                          {p.number("sky_red"), p.number("sky_green"), p.number("sky_blue")}};
    state.defines.emplace_back("SKY", ambient.share > 0 ? "1" : "0");
    sky_ = glm::vec4(sky_radiance(e.scene(), ambient), 1.0);
    shade_ = e.raster(state);
  }
  void record(Context& c) override {
    const std::array<float, 4> sky{sky_.r, sky_.g, sky_.b, sky_.a};
    c.render({{{"color", sky}}, DepthTarget{"depth", {}}, {}}, [&] {
      c.push(shade_, sky_);
      c.draw_fullscreen(shade_);
    });
  }

 private:
  Pipeline shade_;
  glm::vec4 sky_{0, 0, 0, 1};  // radiance
};

GNOMON_PASS("compose", Compose);

}  // namespace
}  // namespace gnomon
