// A technique on a scene where the camera sees no shadow: the same graph without the technique.
#pragma once

#include <optional>

#include "engine/graph/graph.h"

namespace gnomon {

// The graph whose output `visibility`, and whatever else reads what that output shows, is 0 where the
// receiver faces away from the light, else 1: the pass of type "gbuffer" writes it, or, for more lights than
// it has room for, a pass of type "unshadowed" that reads the G-buffer alone. Nothing when the graph has no
// such output or no "gbuffer".
std::optional<Graph> without_shadows(const Graph& graph, uint32_t lights);

}  // namespace gnomon
