// Sets of light views: ranges per light, and what changes from frame to frame.
#include "engine/light/view_set.h"

#include <utility>

namespace gnomon {
namespace {

bool same(const LightView& a, const LightView& b) {
  return a.light_from_world == b.light_from_world && a.half_width == b.half_width &&
         a.half_height == b.half_height && a.near == b.near && a.far == b.far;
}

}  // namespace

ViewSet view_set(std::vector<LightView> views) {
  ViewSet set;
  set.views = std::move(views);
  for (uint32_t i = 0; i < set.views.size(); ++i) {
    const uint32_t light = set.views[i].light;
    if (set.of_light.size() <= light) set.of_light.resize(light + 1, {i, 0});
    ++set.of_light[light].count;
  }
  set.changed.assign(set.of_light.size(), true);
  return set;
}

ViewSet next_view_set(const ViewSet& before, std::vector<LightView> views, const std::vector<bool>& moved) {
  ViewSet set = before;
  set.changed = moved;
  for (size_t i = 0; i < views.size(); ++i)
    if (!same(views[i], before.views[i])) set.changed[views[i].light] = true;
  set.views = std::move(views);
  return set;
}

}  // namespace gnomon
