// A technique on a scene where the camera sees no shadow: the same graph without the technique.
#pragma once

#include <optional>

#include "engine/graph.h"

namespace gnomon {

// The graph whose output `visibility`, and whatever else reads what that output shows, comes from a pass of
// type "unshadowed" that reads the G-buffer alone: 0 where the receiver faces away from the light, else 1.
// Nothing when the graph has no such output or no pass of type "gbuffer".
std::optional<Graph> without_shadows(const Graph& graph);

}  // namespace gnomon
