// The pass prefilter: filters a map's texels by rows, then by columns.
#include <algorithm>
#include <bit>

#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "passes/filtered/moment_basis.h"
#include "passes/map/map_traits.h"
#include "passes/map/receiver_ports.h"

namespace gnomon {
namespace {

constexpr uint32_t kColumns = 64, kTile = 8;  // workgroups of prefilter.glsl: columns, or bands and rows
// Texels that one invocation writes at most.
constexpr uint32_t kBoxBand = 16, kGaussianBand = 4;

uint32_t groups(uint32_t count, uint32_t group) { return (count + group - 1) / group; }

class Prefilter : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary(
        "Filters a map's texels by rows, then by columns; the border "
        "texels are repeated beyond the border.");
    d.cite(
        "van Herk 1992 (the running sums, of additions only); Lauritzen and "
        "McCool 2008 (log space)");
    ImageShape shape = d.input("source", Access::sampled, true, "what is filtered, every layer by itself");
    const int64_t kernel = declare_kernel(d);
    d.choice("shape", "box", {"box", "gaussian"},
             "weights: equal, or Gaussian with a standard deviation of a "
             "quarter of the kernel's width");
    const bool log = read_space(d, "source");
    const bool mips = d.flag("mip_maps", false, "halve the result down to one texel");
    if (mips && log) d.refuse("mip_maps", "false in log space, whose averages are no averages of logarithms");
    d.transient("rows", Access::storage_read | Access::storage_write, true, shape, "filtered by rows");
    Access access = Access::storage_write;
    if (mips) {
      shape.mips = uint32_t(std::bit_width(std::max(shape.extent.width, shape.extent.height)));
      access = access | Access::transfer_read | Access::transfer_write;
    }
    d.output("result", access, true, shape, "filtered by rows and columns");
    d.carry_traits("source", "result");
    d.set_trait("result", map_trait::kKernel, kernel);
    if (!mips) d.reads_around("source", uint32_t(kernel / 2), "result");  // mip levels hold all of the map
  }

  Need need(const SceneFacts&, const Params& params) const override {
    if (params.integer("kernel") > 1 || params.flag("mip_maps")) return Need::run();
    return Need::bypass("result", "source", "the kernel is one texel");
  }

  void prepare(Environment& e) override {
    const uint32_t kernel = uint32_t(e.params().integer("kernel"));
    const bool box = e.params().choice("shape") == "box";
    band_ = box ? std::min(kernel, kBoxBand) : kGaussianBand;
    Defines defines = moment_defines(e.shape("source"), 1);
    if (e.params().flag("mip_maps")) e.check_mips("result");
    defines.emplace_back("KERNEL", std::to_string(kernel));
    defines.emplace_back("BAND", std::to_string(band_));
    columns_ = e.compute("filtered/prefilter.glsl", defines);
    defines.emplace_back("ROWS", "1");
    rows_ = e.compute("filtered/prefilter.glsl", defines);
  }

  void record(Context& c) override {
    const ImageShape shape = c.shape("source");
    const Extent size = shape.extent;
    c.dispatch(rows_, groups(groups(size.width, band_), kTile), groups(size.height, kTile), shape.layers);
    c.own_barrier();
    c.dispatch(columns_, groups(size.width, kColumns), groups(size.height, band_), shape.layers);
    if (!c.params().flag("mip_maps")) return;
    c.own_barrier();
    c.generate_mips("result");
  }

 private:
  Pipeline rows_, columns_;
  uint32_t band_ = 1;
};

GNOMON_PASS("prefilter", Prefilter);

}  // namespace
}  // namespace gnomon
