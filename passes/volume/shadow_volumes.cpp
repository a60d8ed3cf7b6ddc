// The pass shadow_volumes: stencil shadow volumes around every camera pixel.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/gpu_scene.h"
#include "engine/render/render_settings.h"
#include "engine/scene/scene.h"
#include "passes/technique.h"
#include "passes/volume/closed_casters.h"
#include "passes/volume/near_plane_shadow.h"
#include "passes/volume/silhouette_mesh.h"

namespace gnomon {
namespace {

constexpr uint32_t kVertexBytes = 8;                                      // a reference to a vertex
constexpr uint32_t kDrawWords = 4;                                        // of an indirect draw
enum Volume : uint32_t { kSides, kFarCaps, kCaps, kTurnedCaps, kDraws };  // see shadow_volumes.glsl

// Mirrors shaders/glsl/volume/shadow_volumes.glsl.
struct Push {
  uint32_t light, z_fail, triangles, cap_count, first_edge;
};

// Limits: 8 stencil bits count modulo 256, so a point in exactly 256 (512, ...) volumes is taken for lit.
// Alpha-masked casters are cast whole.
class ShadowVolumes : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.kind(PassKind::mixed);
    d.summary(
        "Counts the shadow volumes around every camera pixel in the stencil buffer; more than 255 wrap "
        "around.");
    d.cite(
        "Crow 1977; Heidmann 1991; z-fail: Everitt and Kilgard 2002; silhouettes of open meshes: Kim et al. "
        "2008");
    const ImageShape depth = d.input("depth", Access::sampled, false, "the camera's device depth");
    d.input("geometric", Access::sampled, false, "octahedral geometric normal");
    d.output("visibility", Access::color, true, {depth.extent, d.setting().lights, 1, VK_FORMAT_R32_SFLOAT},
             "0 in shadow, 1 lit; a layer a light");
    makes_shadows(d, "visibility", ShadowKind::hard);
    d.transient("stencil", Access::depth, false, {depth.extent, 1, 1, VK_FORMAT_D32_SFLOAT_S8_UINT},
                "the camera's depth again, and the volumes around each pixel");
    const BufferShape triangles = d.input_buffer("triangles", Access::storage_read, "of `silhouettes`");
    d.input_buffer("facing", Access::storage_read, "of `silhouettes`");
    d.input_buffer("edges", Access::storage_read, "of `silhouettes`");
    d.input_buffer("counts", Access::storage_read, "of `silhouettes`");
    constexpr Access kBoth = Access::storage_read | Access::storage_write;
    // Far caps, and near caps of either kind.
    d.transient_buffer("vertices", Access::storage_write | Access::vertex,
                       {9 * triangles.count, kVertexBytes, "uvec2"}, "caps of the light at hand");
    d.transient_buffer("arguments", kBoth | Access::indirect | Access::transfer_write,
                       {kDrawWords * kDraws, 4, "uint"}, "of the volumes' draws");
  }

  void prepare(Environment& e) override {
    make_pipelines(e);
    const SceneSizes sizes = scene_sizes(e.scene());
    triangle_count_ = uint32_t(sizes.triangles);
    light_edges_ = uint32_t(sizes.sides);
    const std::vector<bool> solid = solid_meshes(e.scene());
    for (const Draw& draw : e.gpu_scene().draws())
      see_through_ =
          see_through_ || may_be_seen_through(draw, solid[e.scene().instances[draw.instance].mesh]);
    casters_ = instance_bounds(e.scene());
    shadowless_ = e.scene_facts().shadowless;
    camera_ = e.settings().camera;
    aspect_ = double(e.settings().width) / e.settings().height;
    far_ = e.settings().reversed_z ? 0.0f : 1.0f;
    choose(e.scene());
    for (size_t i = 0; i < z_fail_.size(); ++i) e.fact(fmt::format("light{}.z_fail", i), z_fail_[i]);
    warn_about_meshes(e);
  }

  void record(Context& c) override {
    if (c.scene().casters_changed()) {
      casters_ = instance_bounds(c.scene().scene());
      chosen_for_.clear();
    }
    choose(c.scene().scene());
    for (uint32_t light = 0; light < z_fail_.size(); ++light) {
      if (light > 0) c.own_barrier();
      if (shadowless_[light].empty()) make_caps(c, light);
      count_volumes(c, light);
    }
  }

 private:
  void make_pipelines(Environment& e) {
    find_caps_ = e.compute("volume/shadow_volumes_caps.glsl");
    RasterState state;
    state.colors = {VK_FORMAT_R32_SFLOAT};
    state.depth = VK_FORMAT_D32_SFLOAT_S8_UINT;
    RasterState copy = state;
    copy.layout = VertexLayout::none;
    copy.vertex = "frame/fullscreen.vert.glsl";
    copy.fragment = "volume/shadow_volumes_begin.glsl";
    copy.depth_test = copy.depth_write = true;
    copy.depth_compare = VK_COMPARE_OP_ALWAYS;
    begin_ = e.raster(copy);

    RasterState resolve = state;
    resolve.layout = VertexLayout::none;
    resolve.vertex = "frame/fullscreen.vert.glsl";
    resolve.fragment = "volume/shadow_volumes_resolve.glsl";
    resolve.stencil.enable = true;
    resolve.stencil.compare = VK_COMPARE_OP_EQUAL;
    resolve_ = e.raster(resolve);

    state.vertex = "volume/shadow_volumes.vert.glsl";
    state.color_write = false;
    state.depth_test = true;
    state.depth_compare = e.settings().reversed_z ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS;
    for (const bool z_fail : {false, true}) {
      state.depth_clamp = true;
      state.layout = VertexLayout::none;
      state.defines = {{"SIDES_OF_EDGES", "1"}, {"NEAR_CAP", "0"}};
      state.stencil = counting(z_fail, false);
      Stage& stage = stages_[z_fail];
      stage.sides = e.raster(state);
      state.layout = VertexLayout::references;
      state.defines = {{"SIDES_OF_EDGES", "0"}, {"NEAR_CAP", "0"}};
      if (z_fail) stage.far_caps = e.raster(state);
      // Near caps must have the G-buffer's depth to the bit, so they are clipped at the near plane as it is.
      // What is lost lies before every pixel.
      state.depth_clamp = false;
      state.defines = {{"SIDES_OF_EDGES", "0"}, {"NEAR_CAP", "1"}};
      stage.caps = e.raster(state);
      state.stencil = counting(z_fail, true);
      stage.turned_caps = e.raster(state);
    }
  }

  // Volumes are wound outwards. z-fail: behind the pixel, leaving counts up and entering down; a cap at the
  // pixel's own depth counts as behind, so that a lit surface does not shadow itself. z-pass: before the
  // pixel, entering counts up.
  static StencilOps counting(bool z_fail, bool turned) {
    VkStencilOp front = z_fail ? VK_STENCIL_OP_DECREMENT_AND_WRAP : VK_STENCIL_OP_INCREMENT_AND_WRAP;
    VkStencilOp back = z_fail ? VK_STENCIL_OP_INCREMENT_AND_WRAP : VK_STENCIL_OP_DECREMENT_AND_WRAP;
    if (turned) std::swap(front, back);
    StencilOps ops;
    ops.enable = true;
    (z_fail ? ops.front_depth_fail : ops.front_pass) = front;
    (z_fail ? ops.back_depth_fail : ops.back_pass) = back;
    return ops;
  }

  // z-fail wherever the near plane may be inside a volume. Asked again only when something has moved.
  void choose(const Scene& scene) {
    const Camera& camera = scene.cameras[camera_];
    std::vector<glm::dmat4> seen{camera.world_from_camera};
    for (const Light& light : scene.lights) seen.push_back(light.world_from_light);
    if (seen == chosen_for_) return;
    chosen_for_ = std::move(seen);
    z_fail_.clear();
    for (const Light& light : scene.lights)
      z_fail_.push_back(near_plane_may_be_shadowed(casters_, camera, aspect_, light));
  }

  // One sentence a kind, naming every mesh once.
  static void warn_about_meshes(Environment& e) {
    std::set<uint32_t> reported;
    std::vector<std::string> open, double_sided, masked;
    for (const Draw& draw : e.gpu_scene().draws()) {
      const uint32_t index = e.scene().instances[draw.instance].mesh;
      if (!reported.insert(index).second) continue;
      const std::string name = fmt::format("'{}'", e.scene().meshes[index].name);
      if (!draw.watertight) open.push_back(name);
      if (draw.watertight && draw.double_sided) double_sided.push_back(name);
      if (draw.alpha_masked) masked.push_back(name);
    }
    const auto warn = [&](const std::vector<std::string>& names, const char* kind, const char* how) {
      if (!names.empty()) e.warn(fmt::format("{} {}: {}", kind, fmt::join(names, ", "), how));
    };
    warn(open, "open mesh", "cast triangle by triangle, slower than a watertight one");
    warn(double_sided, "watertight but double-sided mesh", "cast triangle by triangle");
    warn(masked, "alpha-masked mesh", "cast as if opaque");
  }

  bool has_caps(uint32_t light) const { return z_fail_[light] != 0 || see_through_; }
  Push push_of(uint32_t light) const {
    const uint32_t caps = has_caps(light) ? triangle_count_ : 0;
    return {light, z_fail_[light], triangle_count_, caps, light * light_edges_};
  }

  void make_caps(Context& c, uint32_t light) const {
    const uint32_t n = triangle_count_;
    const uint32_t arguments[kDrawWords * kDraws] = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 3 * n, 0, 0, 1, 6 * n, 0};
    c.update("arguments", std::as_bytes(std::span(arguments)));
    c.own_barrier();
    const Push push = push_of(light);
    c.push(find_caps_, push);
    c.dispatch(find_caps_, std::max(silhouette_groups(push.cap_count), 1u));
    c.own_barrier();
  }

  void count_volumes(Context& c, uint32_t light) const {
    constexpr std::array<float, 4> kShadow{};
    const Stage& stage = stages_[z_fail_[light]];
    c.render({{{"visibility", kShadow}}, DepthTarget{"stencil", far_, 0}, light}, [&] {
      c.push(begin_, push_of(light));
      c.draw_fullscreen(begin_);
      if (shadowless_[light].empty()) {
        draw_volumes(c, stage.sides, kSides);
        if (has_caps(light)) {
          c.bind_vertices("vertices");
          if (z_fail_[light] != 0) draw_volumes(c, stage.far_caps, kFarCaps);
          draw_volumes(c, stage.caps, kCaps);
          draw_volumes(c, stage.turned_caps, kTurnedCaps);
        }
      }
      c.draw_fullscreen(resolve_);
    });
  }

  static void draw_volumes(Context& c, const Pipeline& pipeline, Volume volume) {
    c.draw_indirect(pipeline, "arguments", volume * kDrawWords * sizeof(uint32_t));
  }

  struct Stage {
    Pipeline sides, far_caps, caps,
        turned_caps;  // near caps: triangles wound towards the light, and away from it
  };
  Pipeline find_caps_, begin_, resolve_;
  std::array<Stage, 2> stages_;  // z-pass, z-fail
  uint32_t triangle_count_ = 0, light_edges_ = 0, camera_ = 0;
  bool see_through_ = false;  // some caster's surface
  double aspect_ = 1;
  float far_ = 0;
  std::vector<Bounds> casters_;
  std::vector<std::string> shadowless_;  // SceneFacts
  std::vector<glm::dmat4> chosen_for_;   // the camera and the lights that z_fail_ is for
  std::vector<uint32_t> z_fail_;         // per light
};

GNOMON_PASS("shadow_volumes", ShadowVolumes);

}  // namespace
}  // namespace gnomon
