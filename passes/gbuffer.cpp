#include "engine/context.h"
#include "engine/pass.h"

namespace gnomon {
namespace {

class GBuffer : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.kind(PassKind::raster);
    d.summary("Renders the scene from the camera: depth, normals and albedo of the visible surfaces.");
    d.cite("Saito and Takahashi 1990");
    const Extent size = d.setting().viewport;
    d.output("depth", Access::depth, false, {size, 1, 1, VK_FORMAT_D32_SFLOAT},
             "device depth; reversed z unless asked otherwise, infinite far plane");
    d.output("normal", Access::color, false, {size, 1, 1, VK_FORMAT_R16G16_SNORM},
             "octahedral shading normal");
    d.output("geometric", Access::color, false, {size, 1, 1, VK_FORMAT_R16G16_SNORM},
             "octahedral normal of the triangle, turned to the camera on double-sided meshes");
    d.output("albedo", Access::color, false, {size, 1, 1, VK_FORMAT_R8G8B8A8_SRGB}, "base colour");
  }

  void prepare(Environment& e) override {
    RasterState state;
    state.vertex = "scene.vert.glsl";
    state.fragment = "gbuffer.glsl";
    state.layout = VertexLayout::full;
    state.colors = {VK_FORMAT_R16G16_SNORM, VK_FORMAT_R16G16_SNORM, VK_FORMAT_R8G8B8A8_SRGB};
    state.depth = VK_FORMAT_D32_SFLOAT;
    state.depth_test = state.depth_write = true;
    state.depth_compare = e.settings().reversed_z ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS;
    far_ = e.settings().reversed_z ? 0.0f : 1.0f;
    pipelines_.opaque = e.raster(state);
    state.defines = {{"MASKED", "1"}};
    pipelines_.masked = e.raster(state);
  }

  void record(Context& c) override {
    constexpr std::array<float, 4> kNothing{};
    c.render({{{"normal", kNothing}, {"geometric", kNothing}, {"albedo", kNothing}},
              DepthTarget{"depth", far_},
              {}},
             [&] { c.draw_scene(pipelines_, Cull::material); });
  }

 private:
  ScenePipelines pipelines_;
  float far_ = 0;
};

GNOMON_PASS("gbuffer", GBuffer);

}  // namespace
}  // namespace gnomon
