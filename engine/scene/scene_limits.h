// The range of scenes that can be drawn and traced. Internal to the loader.
#pragma once

#include "engine/scene/scene.h"

namespace gnomon {

// Largest coordinate of what a scene places, and largest side of a light, world units: sums and squares of a
// few stay within a float.
constexpr double kLargestCoordinate = 1e15;
// Of a camera's image, in either direction.
constexpr double kLargestAspect = 1e4;

// Error with one problem for each node, light or camera that is out of range.
void check_limits(const Scene& scene);

}  // namespace gnomon
