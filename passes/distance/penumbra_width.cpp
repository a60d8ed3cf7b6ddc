// The width of a penumbra, as passes declare and read it.
#include "passes/distance/penumbra_width.h"
#include "engine/graph/pass.h"
#include "engine/scene/scene.h"

namespace gnomon {

bool declare_penumbra_width(Declaration& d, double relative) {
  const double world =
      d.number("penumbra", 0.0, 0, 1e9, "world units", "width of the penumbra; 0: penumbra_relative counts");
  return d.number("penumbra_relative", relative, 0, 10, "of the scene's diagonal", "width of the penumbra") >
             0 ||
         world > 0;
}

double penumbra_width(const Scene& scene, const Params& params) {
  const double world = params.number("penumbra"), relative = params.number("penumbra_relative");
  return world > 0 ? world : relative * 2.0 * scene.bounds.radius();
}

}  // namespace gnomon
