// The pass moment_test: visibility from a pre-filtered shadow map.
#include "engine/graph/pass.h"
#include "engine/light/light_view.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/scene/scene.h"
#include "passes/filtered/moment_basis.h"
#include "passes/filtered/summed_area.h"
#include "passes/frame/pixel_list.h"
#include "passes/map/listed_pixels.h"
#include "passes/map/map_domain.h"
#include "passes/map/map_traits.h"
#include "passes/map/receiver_ports.h"
#include "passes/technique.h"

namespace gnomon {
namespace {

class MomentTest : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Visibility of every camera pixel from a pre-filtered shadow map.");
    d.cite(
        "Donnelly and Lauritzen 2006, eq. 5; Annen et al. 2007, eq. 6; "
        "Annen et al. 2008, eq. 4; Lauritzen and McCool "
        "2008; Gumbau et al. 2011 and 2013; Peters and Klein 2015, "
        "algorithm 3; Peters et al. 2017");
    d.darkens_lit_surfaces();  // on slopes and next to anything that the kernel takes in
    const ImageShape visibility = declare_receiver(d);
    const ImageShape moments =
        d.input("moments", Access::sampled, true, "the filtered basis; a view's layers follow each other");
    d.reads_around("shadow_map", 1);
    const bool soft = d.optional_input("width", Access::sampled, true,
                                       "of the penumbra at the receiver, world units: 'moments' is then a "
                                       "summed_area_table, read over the light's shape of that width")
                          .has_value();
    d.optional_input("pyramid", Access::sampled, true,
                     "with 'width': min_max_pyramid of the shadow map; where all of the kernel is lit or in "
                     "umbra it decides, without the light that moments leak");
    read_pyramid(d, "pyramid");
    d.number("narrowest", 1, 0.01, 16, "texels", "with 'width': least width of a kernel");
    d.integer(
        "parts", 1, 1, 8, "1",
        "with 'width': a side of the parts that the kernel is cut in, each against the receiver's plane "
        "at its middle, where surfaces are not parallel to the light (Yang et al. 2010)");
    if (moments.mips == 1 && !soft) d.reads_around("moments", 2);
    read_basis(d, "moments");
    read_kernel(d, "moments");
    read_table(d, "moments", soft);
    refuse_another_map(d);
    d.choice("bound", "chebyshev", {"chebyshev", "gaussian", "gaussian_cdf"},
             "variance bases: Chebyshev's inequality, twice the upper tail of "
             "a normal distribution, or its plain tail, "
             "which leaves lit surfaces half dark");
    d.choice("solver", "hamburger", {"hamburger", "hausdorff"},
             "four_moments: depth unbounded, or known to lie in its range");
    declare_thresholds(d);
    if (soft)
      declare_pixel_list(d, visibility.extent, "pixels whose kernel is neither all lit nor all in umbra");
    d.output("visibility", Access::storage_write, true, visibility, "0 in umbra, 1 lit; a layer a light");
    makes_shadows(d, "visibility", soft ? ShadowKind::soft : ShadowKind::filtered);
  }

  void prepare(Environment& e) override {
    const ImageShape moments = e.shape("moments");
    Defines defines = moment_defines(moments, e.shape("shadow_map").layers);
    if (moments.mips > 1) defines.emplace_back("MIP_MAPS", "1");
    for (auto& define : table_defines(moments, e.params())) defines.push_back(std::move(define));
    test_.prepare(e, "filtered/moment_test.glsl", defines);
    soft_ = e.connected("width");
    if (soft_) find_.prepare(e, "filtered/soft_find.glsl", {{"PLAIN_DECIDES", "1"}});
    report_bias(e);
    warn_about_kernel(e, e.shape("shadow_map").extent.width);
    warn_about_rise(e, e.shape("shadow_map").extent.width);
  }

  void record(Context& c) override {
    if (soft_) return dispatch_listed(c, find_, test_, c.shape("visibility"));
    test_.dispatch_all(c);
  }

 private:
  // The map that tells receivers' places and bias is the one that the moments are made of.
  static void refuse_another_map(Declaration& d) {
    for (const auto& [key, value] : d.find("shadow_map")->traits) {
      const Value* of_moments = d.trait("moments", key);
      if (of_moments && *of_moments != value)
        return d.refuse_source("moments", "is made of another map than 'shadow_map': its " + key + " is " +
                                              to_string(*of_moments) + ", not " + to_string(value));
    }
  }

  static void declare_thresholds(Declaration& d) {
    d.number("minimum_variance", 1e-6, 1e-9, 1e-2, "depth range squared",
             "variance bases: the least that counts");
    d.number("moment_bias", 1, 0, 1000, "times what rounding asks for",
             "four_moments: how much of a fixed distribution is mixed in, so "
             "that rounding leaves valid moments; 1 is "
             "3e-7 (single) or 6e-5 (half)");
    d.number("ringing", 0, 0, 16, "1", "fourier: attenuation of the highest term, as a power of e");
    d.number("bias_kernel", 0, 0, 4, "1",
             "shift of the receiver towards the light, in parts of what its "
             "plane rises over half the kernel");
    d.number("light_leak_reduction", 0, 0, 0.99, "1", "visibility that becomes 0; the rest is stretched");
  }

  bool soft_ = false;
  PerLight find_, test_;
};

GNOMON_PASS("moment_test", MomentTest);

}  // namespace
}  // namespace gnomon
