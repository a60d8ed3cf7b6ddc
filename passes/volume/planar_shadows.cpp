// The pass planar_shadows: casters projected onto the scene's largest planes.
#include <fmt/format.h>

#include <cmath>

#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/gpu_scene.h"
#include "engine/render/render_settings.h"
#include "engine/scene/scene.h"
#include "passes/technique.h"
#include "passes/volume/receiver_planes.h"

namespace gnomon {
namespace {

// Mirrors shaders/glsl/volume/planar_shadows.glsl; the instance is pushed by each draw.
// Of a pixel; with fewer, where vertices are drawn and so their depth is less exact.
constexpr uint32_t kSubPixelBits = 8;

struct Push {
  uint32_t instance, material;  // written by Context::draw
  uint32_t light;
  float tolerance;  // world units
  glm::vec4 plane;  // relative to the eye
};

class PlanarShadows : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.kind(PassKind::raster);
    d.summary(
        "Projects the casters onto the scene's largest planes; other receivers are shaded without shadows.");
    d.cite("Blinn 1988; Rzeczkowski 2024, eq. 3.1-3.3, for any plane and light");
    const ImageShape depth = d.input("depth", Access::sampled, false, "the camera's device depth");
    d.input("geometric", Access::sampled, false, "octahedral geometric normal");
    d.integer("planes", 4, 1, 16, "1", "receivers: the largest groups of coplanar triangles");
    d.output("visibility", Access::color, true, {depth.extent, d.setting().lights, 1, VK_FORMAT_R32_SFLOAT},
             "0 in shadow, 1 lit; a layer a light");
    makes_shadows(d, "visibility", ShadowKind::hard);
  }

  void prepare(Environment& e) override {
    camera_ = e.settings().camera;
    shadowless_ = e.scene_facts().shadowless;
    planes_ = receiver_planes(e.scene(), size_t(e.params().integer("planes")));
    for (size_t i = 0; i < planes_.size(); ++i) e.fact(fmt::format("plane{}.area", i), planes_[i].area);
    e.warn(fmt::format("only the {} largest plane(s) receive shadows", planes_.size()));

    RasterState state;
    state.colors = {VK_FORMAT_R32_SFLOAT};
    state.layout = VertexLayout::none;
    state.vertex = "frame/fullscreen.vert.glsl";
    state.fragment = "volume/planar_shadows_begin.glsl";
    begin_ = e.raster(state);
    state.layout = VertexLayout::positions;
    state.vertex = "volume/planar_shadows.vert.glsl";
    state.fragment = "volume/planar_shadows.frag.glsl";
    if (const uint32_t bits = e.device().limits().subPixelPrecisionBits; bits < kSubPixelBits)
      state.defines.emplace_back("COARSER", std::to_string(1u << (kSubPixelBits - bits)));
    casters_.opaque = e.raster(state);
    state.layout = VertexLayout::masked;
    state.defines.emplace_back("MASKED", "1");
    casters_.masked = e.raster(state);
  }

  void record(Context& c) override {
    const Scene& scene = c.scene().scene();
    for (uint32_t light = 0; light < scene.lights.size(); ++light) {
      constexpr std::array<float, 4> kLit{1, 1, 1, 1};
      c.render({{{"visibility", kLit}}, {}, light}, [&] {
        c.push(begin_, Push{0, 0, light, 0, {}});
        c.draw_fullscreen(begin_);
        if (shadowless_[light].empty())
          for (const ReceiverPlane& plane : planes_) draw_casters(c, scene, plane, light);
      });
    }
  }

 private:
  void draw_casters(Context& c, const Scene& scene, const ReceiverPlane& receiver, uint32_t light) const {
    const glm::dvec3 eye(scene.cameras[camera_].world_from_camera[3]);
    const glm::dvec3 n(receiver.plane);
    const glm::dmat4& frame = scene.lights[light].world_from_light;
    // The light as a homogeneous point; a directional one is the direction to it.
    const glm::dvec4 source = scene.lights[light].type == LightType::directional ? frame[2] : frame[3];
    const double height = glm::dot(receiver.plane, source);
    // Float positions relative to the eye round to this; what is nearer to the plane is the plane itself.
    const double reach = glm::length(scene.bounds.centre() - eye) + scene.bounds.radius();
    const double tolerance = kCoplanarPart * scene.bounds.radius() + 1e-6 * reach;
    const double least = scene.lights[light].type == LightType::directional ? 1e-6 : tolerance;
    if (!(std::abs(height) > least)) return;  // the light lies in the plane and only grazes it
    const glm::dvec4 relative(n, receiver.plane.w + glm::dot(n, eye));
    const Push push{0, 0, light, float(tolerance), glm::vec4(height < 0 ? -relative : relative)};
    c.push(begin_, push);
    c.draw_scene(casters_, Cull::none);
  }

  ScenePipelines casters_;
  Pipeline begin_;
  std::vector<ReceiverPlane> planes_;
  std::vector<std::string> shadowless_;  // SceneFacts
  uint32_t camera_ = 0;
};

GNOMON_PASS("planar_shadows", PlanarShadows);

}  // namespace
}  // namespace gnomon
