// Makes a min-max map of a shadow map over a filter window.
#include "passes/map/min_max_map.h"

#include "engine/base/divide_up.h"
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"

namespace gnomon {
namespace {

constexpr uint32_t kBlock = 8;  // texels a side; shaders: MIN_MAX_BLOCK

}  // namespace

void MinMaxMap::declare(Declaration& d, const ImageShape& shadow_map) {
  d.constant("MIN_MAX_BLOCK", int64_t{kBlock});
  constexpr Access kBoth = Access::storage_read | Access::storage_write;
  const Extent blocks{divide_up(shadow_map.extent.width, kBlock),
                      divide_up(shadow_map.extent.height, kBlock)};
  const ImageShape shape{blocks, shadow_map.layers, 1, VK_FORMAT_R32G32_SFLOAT};
  d.transient("blocks", kBoth, true, shape, "least and greatest depth of blocks of 8x8 texels");
  d.transient("around", kBoth, true, shape, "the same of all blocks that a window from there touches");
}

void MinMaxMap::prepare(Environment& e, uint32_t reach) {
  blocks_ = e.compute("map/min_max_blocks.glsl");
  around_ = e.compute("map/min_max_around.glsl");
  radius_ = int32_t(divide_up(reach, kBlock));
}

void MinMaxMap::record(Context& c) {
  const ImageShape shape = c.shape("blocks");
  c.dispatch_over(blocks_, shape.extent, shape.layers);
  c.own_barrier();
  c.push(around_, radius_);
  c.dispatch_over(around_, shape.extent, shape.layers);
  c.own_barrier();
}

}  // namespace gnomon
