// A light's turn about its own axis, which means nothing where its shape is the same after any.
#pragma once

#include "engine/scene/scene.h"

namespace gnomon {

// Gives point and directional lights that stand still the axes that their direction alone decides, so that
// maps along these axes are those of the light however the file turns it: y points up as far as it can. Left
// as they are: spot lights, whose map is a square of theirs, lights that move, and axes that are within
// rounding of a turn in floats already.
void level_lights(Scene& scene);

}  // namespace gnomon
