// The width of a penumbra that passes agree on.
#pragma once

#include "engine/graph/pass.h"
#include "engine/scene/scene.h"

namespace gnomon {

// Parameters `penumbra` (world units) and `penumbra_relative` (of the scene's diagonal), which counts where
// the first is 0. `relative`: the latter's default. False: both are 0.
bool declare_penumbra_width(Declaration& d, double relative);

// What distances to a silhouette were found for: the penumbra's width in the world and, as `pixels`, in the
// image, and `depth_tolerance`, within which silhouette and receiver are one surface. All are parameters of
// the pass that finds them; a reader takes them from there as derived values.
void set_penumbra_traits(Declaration& d, const std::string& output);
void read_penumbra_traits(Declaration& d, const std::string& input);

// World units.
double penumbra_width(const Scene& scene, const Params& params);

}  // namespace gnomon
