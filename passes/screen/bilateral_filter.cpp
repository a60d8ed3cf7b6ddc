// The pass bilateral_filter: visibility averaged by distance from the pixel and its tangent plane.
#include "engine/graph/pass.h"
#include "passes/screen/strip_filter.h"

namespace gnomon {
namespace {

class BilateralFilter : public StripFilter {
 public:
  BilateralFilter() : StripFilter("screen/bilateral_filter.glsl", "screen/bilateral_filter_soft.glsl") {}
  void declare(Declaration& d) const override {
    d.summary(
        "Averages visibility with weights that fall with distance from the pixel and from its tangent plane, "
        "in place.");
    d.cite("Pham and van Vliet 2005; Macedo 2018, ch. 5");
    StripFilter::declare(d);
    d.number("range_tolerance", 1e-3, 1e-9, 1, "of the view depth",
             "standard deviation of the Gaussian over the distance from the tangent plane");
  }
};

GNOMON_PASS("bilateral_filter", BilateralFilter);

}  // namespace
}  // namespace gnomon
