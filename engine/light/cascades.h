// Cascades: views of a directional light that show what a camera sees, its nearer part more finely.
#pragma once

#include <vector>

#include "engine/light/light_view.h"

namespace gnomon {

struct CascadeSplit {
  uint32_t count = 1;
  // How far from the camera a cascade reaches, as a share of what the next one does; the last one reaches the
  // farthest that the camera sees. 0 to 1.
  double ratio = 0.5;
};

// `count` views, each of which shows all that the camera sees as far as it reaches, and whatever stands
// between that and the light. `whole`: the light's view that shows the scene. `aspect`: width / height of the
// image.
std::vector<LightView> cascades(const Scene& scene, const Camera& camera, double aspect,
                                const LightView& whole, const CascadeSplit& split);

}  // namespace gnomon
