// The pass min_max_pyramid: least and greatest depth of ever larger blocks of a shadow map.
#include <algorithm>
#include <bit>
#include <vector>

#include "engine/base/divide_up.h"
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "passes/map/map_traits.h"

namespace gnomon {
namespace {

class MinMaxPyramid : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary(
        "Least and greatest depth of blocks of a map's texels: blocks of 2x2, 4x4, ... up to all of it.");
    d.cite("Macedo 2018, algorithm 5 (the hierarchical shadow map H)");
    const ImageShape map =
        d.input("shadow_map", Access::sampled, true, "depth from the light, every layer by itself");
    const Extent blocks{divide_up(map.extent.width, 2u), divide_up(map.extent.height, 2u)};
    const auto levels = uint32_t(std::bit_width(std::max(blocks.width, blocks.height)));
    d.output(
        "pyramid", Access::storage_read | Access::storage_write, true,
        {blocks, map.layers, levels, VK_FORMAT_R32G32_SFLOAT},
        "least and greatest depth; level i holds blocks of 2^(i+1) texels a side, of which the last ones "
        "of a level reach to the map's border");
    d.set_trait("pyramid", map_trait::kPyramid, true);
  }

  void prepare(Environment& e) override {
    const uint32_t levels = e.shape("pyramid").mips;
    for (uint32_t level = 0; level < levels; ++level)
      levels_.push_back(e.compute("map/min_max_pyramid.glsl", {{"LEVEL", std::to_string(level)},
                                                               {"PYRAMID_LEVELS", std::to_string(levels)}}));
  }

  void record(Context& c) override {
    const ImageShape shape = c.shape("pyramid");
    Extent size = shape.extent;
    for (const Pipeline& level : levels_) {
      c.dispatch_over(level, size, shape.layers);
      c.own_barrier();
      size = {std::max(size.width / 2, 1u), std::max(size.height / 2, 1u)};
    }
  }

 private:
  std::vector<Pipeline> levels_;
};

GNOMON_PASS("min_max_pyramid", MinMaxPyramid);

}  // namespace
}  // namespace gnomon
