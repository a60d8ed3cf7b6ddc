// The pass gbuffer: depth, normals and albedo of what the camera sees.
#include "engine/graph/pass.h"
#include "engine/graph/shadow_free.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/gpu_scene.h"
#include "engine/render/render_settings.h"
#include "engine/scene/camera.h"

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
    for (const Channel& channel : kChannels) d.omit_unread(channel.port);
    declare_unshadowed(d, size);
  }

  void prepare(Environment& e) override {
    RasterState state;
    state.vertex = "frame/scene.vert.glsl";
    state.fragment = "frame/gbuffer.glsl";
    state.layout = VertexLayout::full;
    add_channels(e, state);
    state.depth = VK_FORMAT_D32_SFLOAT;
    state.depth_test = state.depth_write = true;
    state.depth_compare = e.settings().reversed_z ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS;
    far_ = e.settings().reversed_z ? 0.0f : 1.0f;
    if (far_plane_cuts(e.scene(), e.gpu_scene().camera())) state.defines.emplace_back("FAR_PLANE", "1");
    pipelines_.opaque = e.raster(state);
    if (!e.settings().keep_all) {
      RasterState plain = state;
      plain.layout = VertexLayout::normals;
      plain.defines.emplace_back("PLAIN", "1");
      pipelines_.plain = e.raster(plain);
    }
    state.defines.emplace_back("MASKED", "1");
    pipelines_.masked = e.raster(state);
  }

  void record(Context& c) override {
    c.render({channels_, DepthTarget{"depth", far_}, {}}, [&] { c.draw_scene(pipelines_, Cull::material); });
  }

 private:
  struct Channel {
    const char *port, *define;
  };
  static constexpr std::array<Channel, 3> kChannels = {
      {{"normal", "NORMAL"}, {"geometric", "GEOMETRIC"}, {"albedo", "ALBEDO"}}};

  static constexpr const char* kUnshadowed = "unshadowed";
  static constexpr uint32_t kMostLights = 4;  // colour attachments that every device has beside the channels

  // The visibility of a scene without casters; for more lights than there is room for, a pass makes it.
  static void declare_unshadowed(Declaration& d, Extent size) {
    const uint32_t lights = d.setting().lights;
    if (lights > kMostLights) return d.set_trait("depth", kShadowFreePass, std::string("unshadowed"));
    d.output(kUnshadowed, Access::color, true, {size, lights, 1, VK_FORMAT_R32_SFLOAT},
             "0 facing away from the light, else 1; a layer a light");
    d.omit_unread(kUnshadowed);
    d.set_trait(kUnshadowed, kShadowFree, true);
  }

  // Those that somebody reads, with their places among the colour attachments.
  void add_channels(Environment& e, RasterState& state) {
    constexpr std::array<float, 4> kNothing{};
    for (const Channel& channel : kChannels) {
      if (!e.connected(channel.port)) {
        e.left_out(std::string("channel ") + channel.port, "nobody reads it");
        continue;
      }
      state.defines.emplace_back(channel.define, std::to_string(channels_.size()));
      state.colors.push_back(e.shape(channel.port).format);
      channels_.push_back({channel.port, kNothing});
    }
    if (!e.connected(kUnshadowed)) return;
    state.defines.emplace_back("UNSHADOWED_LOCATION", std::to_string(channels_.size()));
    constexpr std::array<float, 4> kLit{1, 1, 1, 1};
    for (uint32_t light = 0; light < e.shape(kUnshadowed).layers; ++light) {
      state.colors.push_back(VK_FORMAT_R32_SFLOAT);
      channels_.push_back({kUnshadowed, kLit, light});
    }
  }

  std::vector<ColorTarget> channels_;
  ScenePipelines pipelines_;
  float far_ = 0;
};

GNOMON_PASS("gbuffer", GBuffer);

}  // namespace
}  // namespace gnomon
