#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/context.h"
#include "engine/error.h"
#include "engine/pass.h"
#include "passes/divide_up.h"
#include "passes/penumbra_width.h"

namespace gnomon {
namespace {

constexpr uint32_t kWord = 32;              // pixels of a column in a word, as in lib/distance_transform.glsl
constexpr uint32_t kTile = 16;              // as in lib/tiles.glsl
constexpr uint32_t kMostLayers = 256;       // that a packed tile tells apart
constexpr uint32_t kMostSide = 16384;       // pixels: squared distances fit 32 bits
constexpr uint64_t kStripeBytes = 1 << 26;  // of banded_exact's rows: half of what every device binds
constexpr uint32_t kBand = 4096;            // columns that an invocation of distance_transform_envelope takes
constexpr uint32_t kFoundGroup = 64;        // workgroup of distance_transform_resolve

// Rows that banded_exact handles at once: whole words, as many as fit kStripeBytes.
uint32_t stripe_words(Extent size) {
  const uint64_t words = kStripeBytes / (uint64_t(size.width) * kWord * 4);
  return uint32_t(std::clamp<uint64_t>(words, 1, divide_up(size.height, kWord)));
}

// Lengths of jump flooding's steps, in order.
std::vector<uint32_t> flood_steps(const std::string& variant, Extent size) {
  std::vector<uint32_t> halving;
  uint32_t side = 1;
  while (side < std::max(size.width, size.height)) side *= 2;
  for (uint32_t step = side / 2; step > 0; step /= 2) halving.push_back(step);
  std::vector<uint32_t> steps = halving;
  if (variant == "one_plus_jfa") steps.insert(steps.begin(), 1);
  if (variant == "jfa_plus_one") steps.push_back(1);
  if (variant == "jfa_squared") steps.insert(steps.end(), halving.begin(), halving.end());
  return steps;
}

class DistanceTransform : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Finds for every pixel the nearest site: a Euclidean feature transform.");
    d.cite("Cao et al. 2010; Meijster et al. 2000; Rong and Tan 2006; sites: Macedo 2018, ch. 4.2.2");
    const ImageShape source =
        d.input("source", Access::sampled, true, "the image that has the sites; a layer a light");
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
    d.integer(
        "radius", 32, 1, kMostSide, "pixels",
        "of bounded_exact; with a penumbra, it is at least what half of that spans at the nearest site");
    // The penumbra that is to be made of the distances: bounded_exact's radius is then what half of it spans.
    const bool reach = declare_penumbra_width(d, 0);
    d.number("depth_tolerance", 2.5e-4, 0, 1, "of the view depth",
             "distance from a pixel's tangent plane at which a neighbour is on the same surface");
    declare_images(d, source, algorithm);
    declare_lists(d, source, algorithm);
    if ((depth && geometric && sites == "silhouette") || (depth && reach && bounded(algorithm)))
      declare_listed(d, source);
    if (bounded(algorithm) && depth && reach)
      d.transient_buffer("reached", kBoth | Access::transfer_write, {1, 4, "uint"},
                         "the frame's radius, pixels");
  }

  void prepare(Environment& e) override {
    check_limits(e);
    const Params& p = e.params();
    steps_ = flood_steps(p.choice("variant"), e.shape("nearest").extent);
    algorithm_ = p.choice("algorithm");
    const Defines mode_defines = modes();
    const auto compute = [&](const char* name, Defines more = {}) {
      more.insert(more.end(), mode_defines.begin(), mode_defines.end());
      return e.compute(fmt::format("distance_transform_{}.glsl", name), std::move(more));
    };
    pack_ = compute("pack");
    carry_ = compute("carry");
    if (listed_) {
      found_arguments_ = compute("arguments", list("found_arguments", kFoundGroup));
      resolve_ = compute("resolve");
    }
    arguments_ = compute("arguments", list("arguments", 1));
    if (algorithm_ == "banded_exact")
      for (uint32_t band = 0; band < 3; ++band)
        envelope_[band] = compute("envelope", {{"BAND", std::to_string(band)}});
    if (algorithm_ == "jump_flooding") {
      seed_ = compute("seed");
      flood_[0] = compute("flood", {{"FROM", "nearest"}, {"TO", "other"}});
      flood_[1] = compute("flood", {{"FROM", "other"}, {"TO", "nearest"}});
    }
    if (!bounded(algorithm_)) {
      all_tiles_ = compute("all_tiles");
      return;
    }
    tile_columns_ = compute("tile_columns");
    tile_rows_ = compute("tile_rows");
    candidate_arguments_ = compute("arguments", list("candidate_arguments", 1));
    search_ = compute("search");
  }

  void record(Context& c) override {
    const ImageShape shape = c.shape("nearest");
    if (reaching_) c.fill("reached", 0);
    for (uint32_t layer = 0; layer < shape.layers; ++layer) find_sites(c, layer);
    c.own_barrier();
    c.dispatch(carry_, divide_up(shape.extent.width, 32), shape.layers);
    if (bounded(algorithm_))
      search(c, shape);
    else
      list_all(c, shape);
    if (algorithm_ == "banded_exact") sweep(c, shape);
    if (algorithm_ == "jump_flooding") flood(c, shape);
  }

 private:
  static constexpr Access kBoth = Access::storage_read | Access::storage_write;
  static bool bounded(const std::string& algorithm) { return algorithm == "bounded_exact"; }

  static void declare_images(Declaration& d, const ImageShape& source, const std::string& algorithm) {
    const ImageShape nearest{source.extent, source.layers, 1, VK_FORMAT_R32_UINT};
    const bool flooding = algorithm == "jump_flooding";
    const Access access = algorithm == "banded_exact" ? Access::transfer_write
                          : flooding                  ? kBoth
                                                      : Access::storage_write | Access::transfer_write;
    d.output("nearest", access, true, nearest,
             "x | y << 16 of the nearest site, pixels; 0xFFFFFFFF where there is none");
    if (flooding) d.transient("other", kBoth, true, nearest, "sites known after every second step");
    d.transient("words", kBoth, true, words_of(source, VK_FORMAT_R32G32_UINT),
                "sites of 32 rows of a column as bits, and the nearest ones above and below");
    if (algorithm != "banded_exact") return;
    const uint64_t rows = uint64_t(stripe_words(source.extent)) * kWord;
    d.transient_buffer("rows", kBoth | Access::transfer_read, {rows * source.extent.width, 4, "uint"},
                       "proximate sites of each row, then nearest ones, of a stripe of the image");
    d.transient_buffer("counts", kBoth, {rows, 4, "uint"}, "proximate sites of each row so far");
  }

  static void declare_lists(Declaration& d, const ImageShape& source, const std::string& algorithm) {
    const uint64_t tiles = uint64_t(divide_up(source.extent.width, kTile)) *
                           divide_up(source.extent.height, kTile) * source.layers;
    constexpr Access kArguments = kBoth | Access::transfer_write | Access::indirect;
    d.output_buffer(
        "tiles", kBoth, {tiles, 4, "uint"},
        "tiles of 16x16 pixels that have a site within the radius (bounded_exact), or all: x | y << 12 "
        "| layer << 24");
    d.output_buffer("arguments", kArguments, {4, 4, "uint"},
                    "workgroups (x, y, z) of an indirect dispatch of one a tile, and the number of tiles");
    if (!bounded(algorithm)) return;
    d.transient_buffer("tile_gaps", kBoth, {tiles, 4, "int"}, "rows between a tile and its column's sites");
    d.transient_buffer("candidates", kBoth, {tiles, 4, "uint"},
                       "tiles that may have a site within the radius");
    d.transient_buffer("candidate_arguments", kArguments, {4, 4, "uint"}, "of their dispatch");
  }

  static void declare_listed(Declaration& d, const ImageShape& source) {
    const uint64_t pixels = uint64_t(source.extent.width) * source.extent.height;
    d.transient_buffer("found", kBoth, {pixels, 4, "uint"}, "a layer's pixels that the depth decides about");
    d.transient_buffer("found_arguments", kBoth | Access::transfer_write | Access::indirect, {4, 4, "uint"},
                       "of their dispatch");
    d.transient("tested", kBoth, true, words_of(source, VK_FORMAT_R32_UINT), "sites after the test, as bits");
  }

  static ImageShape words_of(const ImageShape& source, VkFormat format) {
    return {{source.extent.width, divide_up(source.extent.height, kWord)}, source.layers, 1, format};
  }

  static Defines list(const char* arguments, uint32_t per_group) {
    return {{"ARGUMENTS", arguments}, {"PER_GROUP", std::to_string(per_group)}};
  }

  void check_limits(Environment& e) {
    const ImageShape shape = e.shape("nearest");
    const Params& p = e.params();
    const bool depth = e.connected("depth"), geometric = e.connected("geometric");
    depth_aware_ = depth && geometric && p.choice("sites") == "silhouette";
    reach_ = float(0.5 * penumbra_width(e.scene(), p));
    reaching_ = bounded(p.choice("algorithm")) && reach_ > 0;
    if (reaching_ && !depth)
      fail(fmt::format("pass '{}' has a penumbra in world units but no depth", e.id()), {}, "penumbra",
           "connect depth, or give the radius in pixels");
    listed_ = depth_aware_ || reaching_;
    if (std::max(shape.extent.width, shape.extent.height) > kMostSide || shape.layers > kMostLayers)
      fail(fmt::format("pass '{}': {}x{} pixels in {} layers, but at most {} a side in {} are possible",
                       e.id(), shape.extent.width, shape.extent.height, shape.layers, kMostSide,
                       kMostLayers));
    const uint64_t bytes = uint64_t(shape.extent.width) * shape.extent.height * 4;
    const uint64_t most = e.device().limits().maxStorageBufferRange;
    if (listed_ && bytes > most)
      fail(fmt::format("pass '{}' lists the sites among {}x{} pixels, {} bytes", e.id(), shape.extent.width,
                       shape.extent.height, bytes),
           {}, {},
           fmt::format("this device's storage buffers have at most {} bytes: use a smaller image", most));
  }

  Defines modes() const {
    const auto flag = [](bool on) { return on ? "1" : "0"; };
    return {{"LISTED", flag(listed_)}, {"DEPTH_AWARE", flag(depth_aware_)}, {"REACHING", flag(reaching_)}};
  }

  void find_sites(Context& c, uint32_t layer) const {
    const Extent size = c.shape("nearest").extent;
    if (listed_) {
      if (layer > 0) c.own_barrier();  // the list is used again
      c.fill("found_arguments", 0);
      c.own_barrier();
    }
    c.push(pack_, std::array<uint32_t, 3>{size.width, size.height, layer});
    c.dispatch(pack_, divide_up(size.width, 128), divide_up(size.height, kWord));
    if (!listed_) return;
    c.own_barrier();
    c.dispatch(found_arguments_, 1);
    c.own_barrier();
    c.push(resolve_, Resolve{layer, reach_});
    c.dispatch_indirect(resolve_, "found_arguments");
  }

  void list_all(Context& c, const ImageShape& shape) const {
    const uint32_t x = divide_up(shape.extent.width, kTile), y = divide_up(shape.extent.height, kTile);
    c.fill("arguments", x * y * shape.layers);
    c.push(all_tiles_, shape.extent);
    c.dispatch(all_tiles_, divide_up(x, 8), divide_up(y, 8), shape.layers);
    c.own_barrier();
    c.dispatch(arguments_, 1);
  }

  void sweep(Context& c, const ImageShape& shape) const {
    const uint32_t words = divide_up(shape.extent.height, kWord), step = stripe_words(shape.extent);
    for (uint32_t layer = 0; layer < shape.layers; ++layer)
      for (uint32_t first = 0; first < words; first += step) {
        const Stripe stripe{shape.extent, layer, first, std::min(step, words - first)};
        sweep(c, stripe);
        c.own_barrier();
        const uint32_t row = first * kWord;
        c.copy_rows(c.buffer("rows"), "nearest",
                    {layer, row, std::min(stripe.count * kWord, shape.extent.height - row)});
      }
  }

  struct Stripe {
    Extent size;                   // of the image
    uint32_t layer, first, count;  // words
  };

  void sweep(Context& c, const Stripe& stripe) const {
    const uint32_t width = stripe.size.width, bands = divide_up(width, kBand);
    const auto band = [&](const Pipeline& pipeline, uint32_t begin) {
      c.own_barrier();
      c.push(pipeline, std::array<uint32_t, 6>{width, stripe.size.height, stripe.layer, stripe.first, begin,
                                               std::min(begin + kBand, width)});
      c.dispatch(pipeline, stripe.count);
    };
    if (bands == 1) return band(envelope_[0], 0);
    for (uint32_t i = 0; i < bands; ++i) band(envelope_[1], i * kBand);
    for (uint32_t i = bands; i-- > 0;) band(envelope_[2], i * kBand);
  }

  void flood(Context& c, const ImageShape& shape) const {
    c.own_barrier();
    c.dispatch_over(seed_, shape.extent, shape.layers);
    // The last step writes `nearest`; the seeds are in both.
    size_t left = steps_.size();
    for (const uint32_t step : steps_) {
      const Pipeline& pipeline = flood_[left-- % 2];
      c.own_barrier();
      c.push(pipeline, step);
      c.dispatch_over(pipeline, shape.extent, shape.layers);
    }
  }

  void search(Context& c, const ImageShape& shape) const {
    const uint32_t x = divide_up(shape.extent.width, kTile), y = divide_up(shape.extent.height, kTile);
    c.fill("arguments", 0);
    c.fill("candidate_arguments", 0);
    c.clear("nearest", ~0u);
    c.own_barrier();
    c.dispatch(tile_columns_, divide_up(x, 8), shape.layers);
    c.own_barrier();
    c.dispatch(tile_rows_, divide_up(x, 8), y, shape.layers);
    c.own_barrier();
    c.dispatch(candidate_arguments_, 1);
    c.own_barrier();
    c.dispatch_indirect(search_, "candidate_arguments");
    c.own_barrier();
    c.dispatch(arguments_, 1);
  }

  struct Resolve {  // push constants
    uint32_t layer;
    float reach;  // world units
  };

  std::string algorithm_;
  float reach_ = 0;
  std::vector<uint32_t> steps_;
  bool depth_aware_ = false, reaching_ = false, listed_ = false;
  Pipeline pack_, found_arguments_, resolve_, carry_, arguments_, all_tiles_;
  Pipeline envelope_[3];  // whole rows, sweep of a band, colouring of a band
  Pipeline seed_, flood_[2];
  Pipeline tile_columns_, tile_rows_, candidate_arguments_, search_;
};

GNOMON_PASS("distance_transform", DistanceTransform);

}  // namespace
}  // namespace gnomon
