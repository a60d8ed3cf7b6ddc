// The width of a penumbra that passes agree on.
#pragma once

#include "engine/graph/pass.h"
#include "engine/scene/scene.h"

namespace gnomon {

// Parameters `penumbra` (world units) and `penumbra_relative` (of the scene's diagonal), which counts where
// the first is 0. `relative`: the latter's default. False: both are 0.
bool declare_penumbra_width(Declaration& d, double relative);

// World units.
double penumbra_width(const Scene& scene, const Params& params);

}  // namespace gnomon
