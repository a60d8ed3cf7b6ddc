// The pass mean_filter: visibility averaged over each pixel's surroundings on its own surface.
#include "engine/graph/pass.h"
#include "passes/screen/strip_filter.h"

namespace gnomon {
namespace {

class MeanFilter : public StripFilter {
 public:
  MeanFilter() : StripFilter("screen/mean_filter.glsl", "screen/mean_filter_soft.glsl") {}
  void declare(Declaration& d) const override {
    d.summary("Averages visibility over each pixel's surroundings on its own surface, in place.");
    d.cite("Macedo 2018, ch. 4.2.3, eq. 4.4-4.5");
    StripFilter::declare(d);
    d.number("depth_tolerance", 1e-3, 0, 1, "of the view depth",
             "distance from each other's tangent plane at which neighbouring pixels still are one surface");
  }
};

GNOMON_PASS("mean_filter", MeanFilter);

}  // namespace
}  // namespace gnomon
