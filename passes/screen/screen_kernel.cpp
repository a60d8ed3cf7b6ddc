// Declares what decides whether a pixel shows the receiver's own surface.
#include "passes/screen/screen_kernel.h"

namespace gnomon {

void declare_surface_test(Declaration& d) {
  d.number("depth_tolerance", 1e-3, 0, 1, "of the view depth",
           "distance from the receiver's tangent plane at which a pixel still shows its surface");
  d.number("bend", 0.1, 0, 1, "1", "sine of the angle that a curved surface may leave the tangent plane by");
}

}  // namespace gnomon
