// Point samples of the scene's area lights.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "passes/area/light_quads.h"
#include "passes/area/sample_maps.h"

namespace gnomon {

// `n` samples of a light, their weights those of their emission: "sobol" (Owen-scrambled), "grid_centres" or
// "grid_corners" (n a square). The centre alone when the light has no area.
std::vector<LightPoint> light_points(const Scene& scene, uint32_t light, uint32_t n,
                                     const std::string& pattern);

// What a quad-tree asks about an area light. `scene` must outlive it.
LightSurface light_surface(const Scene& scene, uint32_t light);

}  // namespace gnomon
