// The pass silhouettes: the casters' edges that bound the shadow of each light.
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/gpu_scene.h"
#include "engine/render/render_settings.h"
#include "engine/scene/scene.h"
#include "passes/volume/closed_casters.h"
#include "passes/volume/silhouette_mesh.h"

namespace gnomon {
namespace {

// Lights whose shadows no camera sees have no silhouette.
class Silhouettes : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Finds the edges of the casters that bound their shadows, for each light.");
    d.cite("Crow 1977; of open meshes: Kim et al. 2008");
    const Declaration::Setting& s = d.setting();
    constexpr Access kRead = Access::storage_read | Access::transfer_write;
    constexpr Access kBoth = Access::storage_read | Access::storage_write;
    d.output_buffer(
        "triangles", kRead, {s.scene.triangles, 16, "uvec4"},
        "casters: three vertices of the scene; instance and flags (passes/volume/silhouette_mesh.h)");
    d.keep("triangles");
    d.transient_buffer("mesh_edges", kRead, {s.scene.edges, 16, "uvec4"}, "all of their edges");
    d.keep("mesh_edges");
    d.transient_buffer("incidents", kRead, {3 * s.scene.triangles, 4, "uint"}, "triangles of each edge");
    d.keep("incidents");
    d.transient_buffer("far_sides", kRead, {s.scene.instances, 4, "uint"},
                       "1: of this instance only triangles that face away from the light cast");
    d.keep("far_sides");
    d.output_buffer(
        "facing", kBoth, {s.lights * s.scene.triangles, 4, "int"},
        "how each triangle casts, for one light after the other: 1 as it is wound, towards the light; "
        "-1 turned over; 0 not at all");
    d.output_buffer(
        "edges", Access::storage_write, {s.lights * s.scene.sides, 16, "uvec4"},
        "silhouette edges, for one light after the other: two vertices, wound towards the light as "
        "their casting triangle is; instance; number of the mesh's edge");
    d.output_buffer("counts", kBoth | Access::transfer_write, {s.lights, 4, "uint"},
                    "of each light's silhouette edges");
  }

  void prepare(Environment& e) override {
    solid_ = solid_meshes(e.scene());
    aspect_ = double(e.settings().width) / e.settings().height;
    const SilhouetteMesh mesh = silhouette_mesh(e.gpu_scene(), solid_);
    triangles_ = uint32_t(mesh.triangles.size());
    edges_ = uint32_t(mesh.edges.size());
    capacity_ = uint32_t(scene_sizes(e.scene()).sides);
    e.write("triangles", std::as_bytes(std::span(mesh.triangles)));
    e.write("mesh_edges", std::as_bytes(std::span(mesh.edges)));
    e.write("incidents", std::as_bytes(std::span(mesh.incidents)));
    find_facing_ = e.compute("volume/silhouettes_facing.glsl");
    find_edges_ = e.compute("volume/silhouettes_edges.glsl");
    shadowless_ = e.scene_facts().shadowless;
    e.fact("triangles", triangles_);
    e.fact("edges", edges_);
  }

  void record(Context& c) override {
    c.fill("counts", 0);
    update_far_sides(c);
    each_light([&](uint32_t light) {
      c.push(find_facing_, std::array<uint32_t, 2>{light, triangles_});
      c.dispatch(find_facing_, silhouette_groups(triangles_));
    });
    c.own_barrier();
    each_light([&](uint32_t light) {
      c.push(find_edges_, std::array<uint32_t, 4>{light, edges_, triangles_, capacity_});
      c.dispatch(find_edges_, silhouette_groups(edges_));
    });
  }

 private:
  // A solid casts from its far side: its caps then never coincide with lit receivers. What is inside of it is
  // not shadowed by its near side then, which nobody sees unless the camera is inside too.
  void update_far_sides(Context& c) {
    if (!far_sides_.empty() && !c.scene().camera_changed() && !c.scene().casters_changed()) return;
    const std::vector<bool> unseen = unseen_inside(c.scene().scene(), solid_, c.scene().camera(), aspect_);
    std::vector<uint32_t> far_sides(unseen.begin(), unseen.end());
    if (far_sides == far_sides_) return;
    far_sides_ = std::move(far_sides);
    constexpr size_t kMost = 65536 / sizeof(uint32_t);  // of Context::update
    const std::span<const uint32_t> all(far_sides_);
    for (size_t at = 0; at < all.size(); at += kMost)
      c.update("far_sides", std::as_bytes(all.subspan(at, std::min(kMost, all.size() - at))),
               at * sizeof(uint32_t));
    c.own_barrier();
  }

  template <typename Do>
  void each_light(const Do& act) const {
    for (uint32_t light = 0; light < shadowless_.size(); ++light)
      if (shadowless_[light].empty()) act(light);
  }

  Pipeline find_facing_, find_edges_;
  uint32_t triangles_ = 0, edges_ = 0, capacity_ = 0;
  double aspect_ = 1;
  std::vector<bool> solid_;              // solid_meshes()
  std::vector<uint32_t> far_sides_;      // the port's content; empty: before the first frame
  std::vector<std::string> shadowless_;  // SceneFacts
};

GNOMON_PASS("silhouettes", Silhouettes);

}  // namespace
}  // namespace gnomon
