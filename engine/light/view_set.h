// The views of all lights that a graph's maps show, and which of them have changed.
#pragma once

#include <vector>

#include "engine/light/light_view.h"

namespace gnomon {

struct ViewSet {
  struct Range {
    uint32_t first = 0, count = 0;
  };
  std::vector<LightView> views;  // light by light, as the layers of maps are
  std::vector<Range> of_light;
  std::vector<bool> changed;  // per light: since the frame before it has moved, or its views are others
};

// Every light has views, and all are changed. `views`: light by light.
ViewSet view_set(std::vector<LightView> views);
// The same set a frame later: `views` are as many; changed are those of other values, and those of lights
// that `moved`, per light, says so of.
ViewSet next_view_set(const ViewSet& before, std::vector<LightView> views, const std::vector<bool>& moved);

}  // namespace gnomon
