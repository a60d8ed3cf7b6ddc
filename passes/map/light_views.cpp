// The pass light_views: what the layers of the lights' maps show, fitted to the scene.
#include <algorithm>
#include <cstring>
#include <optional>

#include "engine/graph/pass.h"
#include "engine/light/cascades.h"
#include "engine/light/light_fit.h"
#include "engine/light/view_set.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/frame_data.h"
#include "engine/render/gpu_scene.h"
#include "engine/render/render_settings.h"
#include "engine/scene/scene.h"

namespace gnomon {
namespace {

// Where a point light's views overlap: 1/32 of a layer on every side lies outside the 90 degrees of a cube's
// face.
constexpr uint32_t kFaceBorderPart = 32;

uint32_t views_of(LightType type, uint32_t cascades) {
  return type == LightType::directional ? cascades : type == LightType::point ? 6 : 1;
}

class LightViews : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary(
        "What the lights' maps show: a view of a spot light, some of a directional and six of a point light, "
        "fitted to the scene.");
    d.cite("cascades: Engel 2006; Zhang et al. 2006");
    const auto cascades = uint32_t(d.integer("cascades", 1, 1, 8, "1", "views of each directional light"));
    d.number(
        "split_ratio", 0.5, 0.01, 1, "1",
        "how far from the camera a cascade reaches, of what the next one does; the last reaches all that is "
        "in view");
    uint32_t count = 0;
    const auto& types = d.setting().light_types;
    for (const LightType type : types) count += views_of(type, cascades);
    const bool others = std::any_of(types.begin(), types.end(),
                                    [](LightType type) { return type != LightType::directional; });
    if (cascades > 1 && others)
      d.refuse("cascades", "1 in a scene with spot or point lights: only directional lights have cascades");
    if (types.empty()) count = d.setting().lights * cascades;
    d.output_buffer(
        "views", Access::host_write, {count, sizeof(LightViewData), "LightView", "lib/light_view.glsl"},
        "light by light; a directional light's from the finest on, a point light's in the order +x -x +y "
        "-y +z -z of its own frame");
  }

  void prepare(Environment& e) override {
    const double aspect = double(e.settings().width) / e.settings().height;
    fit_.emplace(e.scene(), kFaceBorderPart, 1, SeenFrom{e.scene().cameras[e.settings().camera], aspect});
    split_ = {uint32_t(e.params().integer("cascades")), e.params().number("split_ratio")};
    fitted_ = fit_->views(e.scene());
    set_ = view_set(split(e.gpu_scene()));
    e.publish("views", set_);
  }

  void record(Context& c) override {
    const GpuScene& scene = c.scene();
    std::vector<bool> moved(set_.of_light.size());
    for (uint32_t light = 0; light < moved.size(); ++light) moved[light] = scene.light_changed(light);
    const bool any = std::find(moved.begin(), moved.end(), true) != moved.end();
    const bool refit = scene.scene().animation && (any || scene.casters_changed());
    if (refit) fitted_ = fit_->views(scene.scene());
    const bool anew = refit || (split_.count > 1 && scene.camera_changed());
    set_ = next_view_set(set_, anew ? split(scene) : set_.views, moved);
    c.publish("views", set_);
    write(c);
  }

 private:
  std::vector<LightView> split(const GpuScene& scene) const {
    if (split_.count == 1) return fitted_;
    const Camera& camera = scene.camera();
    const glm::vec4& viewport = scene.frame().viewport;
    const double aspect = double(viewport.x) / viewport.y;
    std::vector<LightView> views;
    for (const LightView& whole : fitted_)
      for (const LightView& part : cascades(scene.scene(), camera, aspect, whole, split_))
        views.push_back(part);
    return views;
  }

  // Only what has changed: positions are relative to the eye.
  void write(const Context& c) {
    const glm::dvec3 eye(c.scene().camera().world_from_camera[3]);
    const bool changed = std::find(set_.changed.begin(), set_.changed.end(), true) != set_.changed.end();
    if (!changed && eye_ == eye) return;
    eye_ = eye;
    const std::vector<LightViewData> data = light_view_data(set_.views, eye);
    std::memcpy(c.buffer("views").bytes().data(), data.data(), data.size() * sizeof(LightViewData));
  }

  std::optional<LightFit> fit_;
  std::vector<LightView> fitted_;  // to the scene, before directional lights' are split
  CascadeSplit split_;
  ViewSet set_;
  std::optional<glm::dvec3> eye_;  // what the buffer is relative to
};

GNOMON_PASS("light_views", LightViews);

}  // namespace
}  // namespace gnomon
