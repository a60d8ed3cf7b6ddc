// How much each part of a light counts in its shadows: shapes and textures as weights.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/scene/scene.h"

namespace gnomon {

inline constexpr uint32_t kLightCells = 16;  // on a side of the light's bounding rectangle

// Does some of its bounding rectangle, or of its disc, count more than the rest: is it a polygon, or
// textured?
bool has_uneven_cells(const Light& light);

// Row by row from +y, columns from -x, as the light's map shows it: the mean emission of each cell, of a
// polygon times the share of the cell that is on it; the greatest is 1. All 1 of a light without area.
std::vector<float> light_cells(const Scene& scene, const Light& light);

}  // namespace gnomon
