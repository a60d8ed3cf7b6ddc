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
#include "passes/volume/near_plane_shadow.h"
#include "passes/volume/silhouette_mesh.h"

namespace gnomon {
namespace {

constexpr uint32_t kGroup = 64;          // workgroup size of the silhouette shaders
constexpr uint32_t kMostGroups = 65535;  // what every device dispatches; the shaders step over the rest
constexpr uint32_t kVertexBytes = 8;     // a reference to a vertex
constexpr uint32_t kDraws = 3;  // sides and far caps; near caps wound towards the light; and away from it

// Mirrors shaders/glsl/volume/shadow_volumes.glsl.
struct Push {
  uint32_t light, z_fail, count;
};

uint32_t groups(uint64_t items) {
  return uint32_t(std::min<uint64_t>((items + kGroup - 1) / kGroup, kMostGroups));
}

// Limits: 8 stencil bits count modulo 256, so a point in exactly 256 (512, ...) volumes is taken for lit.
// Alpha-masked casters are cast whole. A watertight single-sided mesh casts from its far side alone: what the
// camera sees of other objects inside of it is not shadowed by its near side.
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
    d.transient("stencil", Access::depth, false, {depth.extent, 1, 1, VK_FORMAT_D32_SFLOAT_S8_UINT},
                "the camera's depth again, and the volumes around each pixel");
    constexpr Access kBoth = Access::storage_read | Access::storage_write;
    d.transient_buffer("triangles", kBoth, {1, 16, "uvec4"}, "casters");
    d.transient_buffer("edges", kBoth, {1, 16, "uvec4"}, "their edges");
    d.transient_buffer("incidents", kBoth, {1, 4, "uint"}, "triangles of each edge");
    d.transient_buffer("facing", kBoth, {1, 4, "int"}, "how each triangle casts for the light at hand");
    d.transient_buffer("vertices", kBoth | Access::vertex, {1, kVertexBytes, "uvec2"},
                       "volumes of the light at hand");
    d.transient_buffer("arguments", kBoth | Access::indirect | Access::transfer_write,
                       {4 * kDraws, 4, "uint"}, "of the volumes' draws");
  }

  void prepare(Environment& e) override {
    make_geometry(e);
    make_pipelines(e);
    casters_ = instance_bounds(e.scene());
    shadowless_ = e.scene_facts().shadowless;
    camera_ = e.settings().camera;
    aspect_ = double(e.settings().width) / e.settings().height;
    far_ = e.settings().reversed_z ? 0.0f : 1.0f;
    choose(e.scene());
    for (size_t i = 0; i < z_fail_.size(); ++i) e.fact(fmt::format("light{}.z_fail", i), z_fail_[i]);
    e.fact("triangles", triangle_count_);
    e.fact("edges", edge_count_);
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
      if (shadowless_[light].empty()) make_volumes(c, light);
      count_volumes(c, light);
    }
  }

 private:
  void make_geometry(Environment& e) {
    const SilhouetteMesh mesh = silhouette_mesh(e.gpu_scene());
    triangle_count_ = uint32_t(mesh.triangles.size());
    edge_count_ = uint32_t(mesh.edges.size());
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    triangles_ = e.upload(std::as_bytes(std::span(mesh.triangles)), kStorage);
    edges_ = e.upload(std::as_bytes(std::span(mesh.edges)), kStorage);
    incidents_ = e.upload(std::as_bytes(std::span(mesh.incidents)), kStorage);
    facing_ = e.buffer(4ull * triangle_count_, kStorage);
    // Sides of two triangles each and far caps, then the two kinds of near caps.
    near_first_ = 6 * mesh.most_quads + 3ull * triangle_count_;
    vertices_ = e.buffer(kVertexBytes * (near_first_ + 6ull * triangle_count_),
                         kStorage | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    e.attach("triangles", triangles_);
    e.attach("edges", edges_);
    e.attach("incidents", incidents_);
    e.attach("facing", facing_);
    e.attach("vertices", vertices_);
  }

  void make_pipelines(Environment& e) {
    find_facing_ = e.compute("volume/shadow_volumes_facing.glsl");
    find_silhouette_ = e.compute("volume/shadow_volumes_silhouette.glsl");
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
    state.layout = VertexLayout::references;
    state.color_write = false;
    state.depth_test = true;
    state.depth_compare = e.settings().reversed_z ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS;
    for (const bool z_fail : {false, true}) {
      state.depth_clamp = true;
      state.defines = {{"NEAR_CAP", "0"}};
      state.stencil = counting(z_fail, false);
      Stage& stage = stages_[z_fail];
      stage.sides = e.raster(state);
      // Near caps must have the G-buffer's depth to the bit, so they are clipped at the near plane as it is.
      // What is lost lies before every pixel.
      state.depth_clamp = false;
      state.defines = {{"NEAR_CAP", "1"}};
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

  void make_volumes(Context& c, uint32_t light) const {
    const uint32_t near_first = uint32_t(near_first_);
    const uint32_t arguments[4 * kDraws] = {
        0, 1, 0, 0, 0, 1, near_first, 0, 0, 1, near_first + 3 * triangle_count_, 0};
    vkCmdUpdateBuffer(c.commands(), c.buffer("arguments").handle(), 0, sizeof(arguments), arguments);
    c.own_barrier();
    Push push{light, z_fail_[light], triangle_count_};
    c.push(find_facing_, push);
    c.dispatch(find_facing_, groups(triangle_count_));
    c.own_barrier();
    push.count = edge_count_;
    c.push(find_silhouette_, push);
    c.dispatch(find_silhouette_, groups(edge_count_));
    c.own_barrier();
  }

  void count_volumes(Context& c, uint32_t light) const {
    constexpr std::array<float, 4> kShadow{};
    const Stage& stage = stages_[z_fail_[light]];
    c.render({{{"visibility", kShadow}}, DepthTarget{"stencil", far_, 0}, light}, [&] {
      const Push push{light, z_fail_[light], 0};
      c.push(begin_, push);
      c.draw_fullscreen(begin_);
      const VkBuffer vertices = vertices_.handle();
      constexpr VkDeviceSize kStart = 0;
      vkCmdBindVertexBuffers(c.commands(), 0, 1, &vertices, &kStart);
      if (shadowless_[light].empty()) {
        draw_volumes(c, stage.sides, 0);
        draw_volumes(c, stage.caps, 1);
        draw_volumes(c, stage.turned_caps, 2);
      }
      c.draw_fullscreen(resolve_);
    });
  }

  static void draw_volumes(Context& c, const Pipeline& pipeline, uint32_t index) {
    c.bind(pipeline);
    c.set_cull(VK_CULL_MODE_NONE);
    constexpr uint32_t kStride = sizeof(VkDrawIndirectCommand);
    vkCmdDrawIndirect(c.commands(), c.buffer("arguments").handle(), index * kStride, 1, kStride);
  }

  struct Stage {
    Pipeline sides, caps, turned_caps;  // near caps: triangles wound towards the light, and away from it
  };
  Pipeline find_facing_, find_silhouette_, begin_, resolve_;
  std::array<Stage, 2> stages_;  // z-pass, z-fail
  Buffer triangles_, edges_, incidents_, facing_, vertices_;
  uint32_t triangle_count_ = 0, edge_count_ = 0, camera_ = 0;
  uint64_t near_first_ = 0;
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
