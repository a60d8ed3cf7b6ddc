// Spot lights whose cone no square frustum holds.
#pragma once

#include <numbers>

#include "engine/scene/scene.h"

namespace gnomon {

constexpr double kWidestMap = 169.0 / 180.0 * std::numbers::pi;  // radians, of a spot's square frustum

// The frustum is as wide as one may be, and less wide than the cone.
inline bool is_cut(const Light& light) {
  return light.type == LightType::spot && light.map_fov >= kWidestMap && 2.0 * light.outer_cone > kWidestMap;
}

// The type of light whose views show all that a light shines on: a point light's, where the cone is too wide.
// Area lights keep their one view, whose frustum grows with the light's size.
inline LightType view_type(const Light& light) {
  return is_cut(light) && !light.area ? LightType::point : light.type;
}

}  // namespace gnomon
