// What separable, edge-aware filters of visibility share: strips of the image, along x, then y.
#include "passes/screen/strip_filter.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <string>

#include "engine/base/divide_up.h"
#include "engine/graph/pass.h"
#include "engine/light/scene_facts.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/render_settings.h"
#include "passes/distance/distance_transform_ports.h"

namespace gnomon {
namespace {

constexpr uint32_t kCell = 8, kStrip = 8;  // pixels; cells; shaders: CELL, STRIP
constexpr uint32_t kListGroup = 64;        // invocations
constexpr uint64_t kWord = 4;              // bytes
constexpr uint64_t kAlongX = 0, kAlongY = 4, kReach = 8, kControlWords = 9;

constexpr Access kList = Access::storage_read | Access::storage_write;

struct Strips {
  uint32_t cells_x, cells_y, along_x, along_y, layers;
  explicit Strips(const ImageShape& shape)
      : cells_x(divide_up(shape.extent.width, kCell)),
        cells_y(divide_up(shape.extent.height, kCell)),
        along_x(divide_up(cells_x, kStrip) * cells_y),
        along_y(cells_x * divide_up(cells_y, kStrip)),
        layers(shape.layers) {}
};

void clear_lists(Context& c) {
  for (const uint64_t list : {kAlongX, kAlongY}) {
    c.fill("control", 0, list * kWord, 2 * kWord);    // workgroups in x and y
    c.fill("control", 1, (list + 2) * kWord, kWord);  // in z
    c.fill("control", 0, (list + 3) * kWord, kWord);  // strips
  }
  c.fill("control", 0, kReach * kWord, kWord);
}

// View depth, world units, at which the window has its width.
double reference_depth(const SceneFacts& facts, const Params& params) {
  const double given = params.number("reference_depth");
  return given > 0 ? given : facts.middle_depth;
}

constexpr double kMostOfImage = 0.25;  // share of the image's smaller side that the filter may be wide

void warn_about_width(Environment& e) {
  const double width = e.params().number("width");
  const uint32_t side = std::min(e.settings().width, e.settings().height);
  if (width > 1 && width > kMostOfImage * side)
    e.warn("a filter of " + std::to_string(std::lround(width)) + " pixels is wide for an image of " +
           std::to_string(side));
}

}  // namespace

void StripFilter::declare(Declaration& d) const {
  d.constant("CELL", int64_t{kCell});
  d.constant("STRIP", int64_t{kStrip});
  distance_transform::declare_units(d);
  const ImageShape shape = d.inout("visibility", Access::storage_read | Access::storage_write, true,
                                   "what is filtered; a layer a light");
  d.optional_input_behind("views", "visibility", Access::uniform, "what the shadow map's layers show");
  d.input("depth", Access::sampled, false, "the camera's device depth");
  d.input("geometric", Access::sampled, false, "octahedral geometric normal");
  d.number(
      "width", 15, 0, 63, "pixels",
      "of the window at the reference depth; it goes with 1/depth, up to 63 pixels (Macedo 2018, eq. 4.4)");
  d.number("reference_depth", 0, 0, 1e9, "world units",
           "view depth at which the window has its width; 0: the camera's distance to the scene's middle");
  soft_ =
      d.optional_input("width", Access::sampled, true,
                       "of the penumbra at the receiver, world units: the window is then as wide as that is "
                       "at the pixel's depth, whatever the parameter says")
          .has_value();
  d.integer("largest", 127, 1, 1023, "pixels",
            "with a width for each pixel: how far the window reaches to each side at most");
  d.optional_input_buffer(
      "tiles", Access::storage_read,
      "tiles of 16x16 pixels outside of which visibility is plain: without them, it is looked for");
  d.optional_input_buffer("arguments", Access::storage_read | Access::indirect,
                          "workgroups (x, y, z) and number of tiles");
  const Strips strips(shape);
  const uint64_t layers = shape.layers;
  d.transient("rows", kList, true, {shape.extent, shape.layers, 1, VK_FORMAT_R32_SFLOAT}, "filtered along x");
  // What the G-buffer holds, so that the second direction reads one image instead of two.
  d.transient("surfaces", kList, true, {shape.extent, shape.layers, 1, VK_FORMAT_R32G32_UINT},
              "device depth and octahedral geometric normal of what is filtered");
  d.transient_buffer("cell_states", kList | Access::transfer_write,
                     {uint64_t(strips.cells_x) * strips.cells_y * layers, 4, "uint"},
                     "whether each cell of 8x8 pixels holds light, shadow, both or nothing of its own");
  d.transient_buffer("needed_y", kList, {strips.along_y * layers, 4, "uint"},
                     "cells of each strip along y that the filter may change, a bit each");
  d.transient_buffer("needed_x", kList, {strips.along_x * layers, 4, "uint"},
                     "cells of each strip along x that the filter along y reads, a bit each");
  d.transient_buffer("strips_y", kList, {strips.along_y * layers, 4, "uint"}, "strips along y to filter");
  d.transient_buffer("strips_x", kList, {strips.along_x * layers, 4, "uint"}, "strips along x to filter");
  d.transient_buffer("control", kList | Access::indirect | Access::transfer_write, {kControlWords, 4, "uint"},
                     "arguments of both lists, and the reach of the widest filter in pixels");
}

Need StripFilter::need(const SceneFacts& facts, const Params& params) const {
  if (soft_) return Need::run();
  const double widest =
      params.number("width") * reference_depth(facts, params) / std::max(facts.nearest_depth, 1e-300);
  if (widest > 1) return Need::run();
  return Need::bypass("visibility", "visibility", "the filter is nowhere wider than a pixel");
}

void StripFilter::prepare(Environment& e) {
  tiled_ = e.connected("tiles") && e.connected("arguments");
  const std::string shader = soft_ ? soft_shader_ : shader_;
  classify_ = e.compute(tiled_ ? "screen/strip_filter_tiles.glsl" : "screen/strip_filter_classify.glsl");
  list_y_ = e.compute("screen/strip_filter_list_y.glsl");
  list_x_ = e.compute("screen/strip_filter_list_x.glsl");
  along_x_ = e.compute(shader);
  along_y_ = e.compute(shader, {{"ALONG_Y_AXIS", "1"}});
  if (!soft_) warn_about_width(e);
  reference_depth_ = float(reference_depth(e.scene_facts(), e.params()));
  e.fact("reference_depth", reference_depth_);
}

void StripFilter::record(Context& c) {
  const Strips strips(c.shape("visibility"));
  const auto run = [&](const Pipeline& pipeline, auto&& dispatch) {
    c.own_barrier();
    c.bind(pipeline);
    c.push(pipeline, reference_depth_);
    dispatch(pipeline);
  };
  c.section("lists");
  clear_lists(c);
  if (tiled_) c.fill("cell_states", 0);
  run(classify_, [&](const Pipeline& p) {
    if (tiled_)
      c.dispatch_indirect(p, "arguments");
    else
      c.dispatch_over(p, {strips.cells_x, strips.cells_y}, strips.layers);
  });
  run(list_y_,
      [&](const Pipeline& p) { c.dispatch(p, divide_up(strips.along_y, kListGroup), 1, strips.layers); });
  run(list_x_,
      [&](const Pipeline& p) { c.dispatch(p, divide_up(strips.along_x, kListGroup), 1, strips.layers); });
  c.section("along_x");
  run(along_x_, [&](const Pipeline& p) { c.dispatch_indirect(p, "control", kAlongX * kWord); });
  c.section("along_y");
  run(along_y_, [&](const Pipeline& p) { c.dispatch_indirect(p, "control", kAlongY * kWord); });
}

}  // namespace gnomon
