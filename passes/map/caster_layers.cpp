// Which casters are drawn into which views of a shadow map.
#include "passes/map/caster_layers.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/light/caster_culling.h"
#include "engine/light/light_view.h"
#include "engine/light/scene_facts.h"
#include "engine/light/view_set.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/gpu_scene.h"
#include "engine/render/render_settings.h"
#include "engine/scene/scene.h"

namespace gnomon {
namespace {

bool holds(const std::vector<std::vector<bool>>& all, const std::vector<std::vector<bool>>& part) {
  for (size_t view = 0; view < part.size(); ++view)
    for (size_t i = 0; i < part[view].size(); ++i)
      if (part[view][i] && !all[view][i]) return false;
  return true;
}

std::vector<LayerRun> runs_of(const std::vector<std::vector<bool>>& needed, size_t instance) {
  std::vector<LayerRun> runs;
  for (uint32_t view = 0; view < needed.size(); ++view) {
    if (!needed[view][instance]) continue;
    if (runs.empty() || runs.back().first + runs.back().count != view) runs.push_back({view, 0});
    ++runs.back().count;
  }
  return runs;
}

}  // namespace

void CasterLayers::prepare(Environment& e, const std::string& map) {
  reach_ = e.reach(map);
  shadowless_ = e.scene_facts().shadowless;
  all_ = e.settings().keep_all;
  camera_ = e.settings().camera;
  size_ = e.shape(map).extent.width;
  aspect_ = double(e.settings().width) / e.settings().height;
  drawn_ = needed(e.scene(), e.views("views"));
  draw_later(drawn_);
  if (all_) return;
  for (size_t light = 0; light < shadowless_.size(); ++light)
    if (!shadowless_[light].empty())
      e.left_out(fmt::format("casters of light '{}'", e.scene().lights[light].name), shadowless_[light]);
  const size_t all = e.scene().instances.size() * drawn_.size();
  if (draws_ < double(all))
    e.left_out(fmt::format("{} of {} draws", double(all) - draws_, all),
               reach_ ? "their shadows cannot reach what the camera sees" : "no view of the map holds them");
}

CasterLayers::Needed CasterLayers::needed(const Scene& scene, const ViewSet& views) const {
  if (all_) return Needed(views.views.size(), std::vector<bool>(scene.instances.size(), true));
  const Camera& camera = scene.cameras[camera_];
  return casters_in_view(scene, camera, aspect_, views.views, size_, reach_, shadowless_);
}

void CasterLayers::draw_later(const Needed& needed) {
  layers_.clear();
  draws_ = 0;
  const size_t instances = needed.empty() ? 0 : needed.front().size();
  for (size_t i = 0; i < instances; ++i) {
    layers_.push_back(runs_of(needed, i));
    for (const LayerRun& run : layers_.back()) draws_ += run.count;
  }
}

bool CasterLayers::update(const Context& c, bool keep) {
  const GpuScene& scene = c.scene();
  const ViewSet& views = c.views("views");
  const bool moved = scene.casters_changed() ||
                     std::find(views.changed.begin(), views.changed.end(), true) != views.changed.end();
  if (!moved && !scene.camera_changed()) return keep;
  const Needed now = needed(scene.scene(), views);
  if (keep && !moved && holds(drawn_, now)) return true;
  drawn_ = now;
  draw_later(drawn_);
  return false;
}

}  // namespace gnomon
