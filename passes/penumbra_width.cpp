#include "passes/penumbra_width.h"

namespace gnomon {

void declare_penumbra_width(Declaration& d) {
  d.number("penumbra", 0.0, 0, 1e9, "world units", "width of the penumbra; 0: penumbra_relative counts");
  d.number("penumbra_relative", 0.014, 0, 10, "of the scene's diagonal", "width of the penumbra");
}

double penumbra_width(const Scene& scene, const Params& params) {
  const double world = params.number("penumbra"), relative = params.number("penumbra_relative");
  return world > 0 ? world : relative * 2.0 * scene.bounds.radius();
}

}  // namespace gnomon
