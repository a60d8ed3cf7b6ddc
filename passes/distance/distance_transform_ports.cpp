// Parameters and ports of the pass distance_transform, and the units in which it works.
#include "passes/distance/distance_transform_ports.h"

#include <algorithm>

#include "engine/base/divide_up.h"
#include "engine/graph/pass.h"
#include "passes/distance/penumbra_width.h"

namespace gnomon::distance_transform {
namespace {

constexpr Access kBoth = Access::storage_read | Access::storage_write;
constexpr Access kArguments = kBoth | Access::transfer_write | Access::indirect;
constexpr uint64_t kStripeBytes = 1 << 26;  // of banded_exact's rows: half of what every device binds

bool bounded(const std::string& algorithm) { return algorithm == "bounded_exact"; }

// Of the words of a column, which may be grouped by `columns`.
ImageShape words_of(const ImageShape& source, uint32_t columns = 1) {
  return {{divide_up(source.extent.width, columns), divide_up(source.extent.height, kWord)},
          source.layers,
          1,
          VK_FORMAT_R32_UINT};
}

void declare_images(Declaration& d, const ImageShape& source, const std::string& algorithm) {
  const ImageShape nearest{source.extent, source.layers, 1, VK_FORMAT_R32_UINT};
  const bool flooding = algorithm == "jump_flooding";
  const Access access = algorithm == "banded_exact" ? Access::transfer_write
                        : flooding                  ? kBoth
                                                    : Access::storage_write | Access::transfer_write;
  d.output("nearest", access, true, nearest,
           "x | y << 16 of the nearest site, pixels; 0xFFFFFFFF where there is none");
  if (flooding) d.transient("other", kBoth, true, nearest, "sites known after every second step");
  d.transient("words", kBoth, true, words_of(source), "sites of 32 rows of a column as bits");
  d.transient("carries", kBoth, true, words_of(source), "the nearest sites above and below such a word");
}

void declare_envelope(Declaration& d, const ImageShape& source) {
  d.transient("kept", kBoth, true, words_of(source, kChunk),
              "columns that hold nearest sites of a word's rows, as bits");
  const uint64_t rows = uint64_t(stripe_words(source.extent)) * kWord;
  d.transient_buffer("rows", kBoth | Access::transfer_read, {rows * source.extent.width, 4, "uint"},
                     "proximate sites of each row, then nearest ones, of a stripe of the image");
  d.transient_buffer("counts", kBoth, {rows, 4, "uint"}, "proximate sites of each row so far");
}

void declare_lists(Declaration& d, const ImageShape& source, const std::string& algorithm) {
  const uint64_t tiles = uint64_t(divide_up(source.extent.width, kTile)) *
                         divide_up(source.extent.height, kTile) * source.layers;
  d.output_buffer(
      "tiles", kBoth, {tiles, 4, "uint"},
      "tiles of 16x16 pixels that have a site within the radius (bounded_exact), or all: x | y << 12 "
      "| layer << 24");
  d.output_buffer("arguments", kArguments, {4, 4, "uint"},
                  "workgroups (x, y, z) of an indirect dispatch of one a tile, and the number of tiles");
  if (!bounded(algorithm)) return;
  d.transient_buffer("candidates", kBoth, {tiles, 4, "uint"}, "tiles that may have a site within the radius");
  d.transient_buffer(
      "candidate_arguments", kArguments, {9, 4, "uint"},
      "of their dispatch for small radii, then of that for large ones; workgroups that are done");
}

void declare_listed(Declaration& d, const ImageShape& source) {
  const uint64_t pixels = uint64_t(source.extent.width) * source.extent.height;
  d.transient_buffer("found", kBoth, {pixels, 4, "uint"}, "a layer's pixels that the depth decides about");
  d.transient_buffer("found_arguments", kArguments, {4, 4, "uint"}, "of their dispatch");
}

}  // namespace

uint32_t stripe_words(Extent size) {
  const uint64_t words = kStripeBytes / (uint64_t(size.width) * kWord * 4);
  return uint32_t(std::clamp<uint64_t>(words, 1, divide_up(size.height, kWord)));
}

void declare_units(Declaration& d) {
  d.constant("WORD", int64_t{kWord});
  d.constant("CHUNK", int64_t{kChunk});
  d.constant("TILE", int64_t{kTile});
}

void declare_ports(Declaration& d) {
  declare_units(d);
  d.summary("Finds for every pixel the nearest site: a Euclidean feature transform.");
  d.cite("Cao et al. 2010; Meijster et al. 2000; Rong and Tan 2006; sites: Macedo 2018, ch. 4.2.2");
  const ImageShape source =
      d.input("source", Access::sampled, true, "the image that has the sites; a layer a light");
  d.optional_input_behind("views", "source", Access::uniform, "what the shadow map's layers show");
  const bool depth =
      d.optional_input("depth", Access::sampled, false, "the camera's device depth").has_value();
  const bool geometric =
      d.optional_input("geometric", Access::sampled, false, "octahedral geometric normal").has_value();
  const std::string algorithm =
      d.choice("algorithm", "bounded_exact", {"banded_exact", "bounded_exact", "jump_flooding"},
               "exact; exact within the radius and none beyond, at a cost that follows the tiles there; "
               "approximate");
  d.choice("variant", "jfa", {"jfa", "one_plus_jfa", "jfa_plus_one", "jfa_squared"}, "of jump_flooding");
  const std::string sites =
      d.choice("sites", "nonzero", {"nonzero", "silhouette"},
               "pixels that are not 0, or that differ from one of their eight neighbours (with depth and "
               "geometric: one on the same surface)");
  d.integer("radius", 32, 1, kMostSide, "pixels", "of bounded_exact; a penumbra may ask for more");
  // The penumbra that is to be made of the distances: bounded_exact's radius is at least what half of it
  // spans.
  const bool reach = declare_penumbra_width(d, 0);
  d.number("pixels", 0, 0, kMostSide, "pixels", "width of the penumbra in the screen metric");
  d.number("depth_tolerance", 2.5e-4, 0, 1, "of the view depth",
           "distance from a pixel's tangent plane at which a neighbour is on the same surface");
  declare_images(d, source, algorithm);
  set_penumbra_traits(d, "nearest");
  if (algorithm == "banded_exact") declare_envelope(d, source);
  declare_lists(d, source, algorithm);
  const bool reaching = bounded(algorithm) && depth && reach;
  if ((depth && geometric && sites == "silhouette") || reaching) declare_listed(d, source);
  if (reaching)
    d.transient_buffer("reached", kBoth | Access::transfer_write, {1, 4, "uint"},
                       "the frame's radius, pixels");
}

}  // namespace gnomon::distance_transform
