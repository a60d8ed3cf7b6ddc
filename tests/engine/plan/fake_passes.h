// Pass types for tests of graphs and plans. They never record anything.
#pragma once

#include <string>

#include "engine/graph/graph.h"
#include "engine/graph/pass.h"
#include "engine/scene/scene.h"

namespace gnomon::test {

// Registers, once, the types that the tests' graph files use:
//   t_source      -> color (R8G8B8A8_UNORM), depth (D32_SFLOAT, depth attachment); raster
//   t_value       -> result (R32_SFLOAT storage, viewport); parameter level
//   t_filter      source -> result; parameters width, mode, clamp
//   t_blend       a, b, optional c -> result
//   t_modify      target (inout, storage), optional guide
//   t_overlay     target (inout, colour attachment); raster
//   t_count       source -> count (host-readable buffer)
//   t_host        count (host), optional source -> result
//   t_step        state (inout buffer), optional guide -> votes (host-readable buffer)
//   t_decide      votes (host), optional source -> result; a loop's controller
//   t_buffer      -> data (buffer)
//   t_sum         data (buffer) -> result
//   t_history     source, last (history) -> result
//   t_scratch     source -> result, with a transient image
//   t_constant    source -> result; need(): constant 1 unless the scene has triangles
//   t_bypass      source -> result; need(): bypass unless the scene has triangles
//   t_layers      -> result with one layer per light
//   t_huge        -> result of a given size
//   t_batches     -> result, with a transient of 64 x 64 texels and up to 16 layers that the memory holds
//   t_target      -> target, guide (both R32_SFLOAT storage)
//   t_says        -> result that says its `tone`, and `parts` = 3
//   t_carries     source -> result that says what the source says, and `filtered`
//   t_asks        source -> result; `tone` is the source's; one without is refused; optional last (history)
void register_fake_passes();

}  // namespace gnomon::test
