// What passes share that look at the receiver's own surface on the screen, over a kernel that is the light's:
// shaders/glsl/screen/screen_kernel.glsl.
#pragma once

#include "engine/graph/pass.h"

namespace gnomon {

// Parameters `depth_tolerance` and `bend`: what still is the receiver's own surface.
void declare_surface_test(Declaration& d);

}  // namespace gnomon
