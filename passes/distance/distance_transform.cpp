// The pass distance_transform: for every pixel the nearest site, by one of several algorithms.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/divide_up.h"
#include "engine/base/error.h"
#include "engine/graph/pass.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/scene/scene.h"
#include "passes/distance/distance_transform_ports.h"
#include "passes/distance/penumbra_width.h"

namespace gnomon {

using namespace distance_transform;

namespace {

constexpr uint32_t kBand = 4096;      // columns that an invocation of distance_transform_envelope takes
constexpr uint32_t kPackGroup = 32;   // invocations of distance_transform_pack
constexpr uint32_t kPackSquare = 16;  // of these, that share a square at most (lib/bit_matrix.glsl)
constexpr uint32_t kPruneGroup = 8, kPruneSpan = 1024;  // invocations and columns of distance_transform_prune
constexpr uint32_t kFoundGroup = 64;                    // of distance_transform_resolve
constexpr uint64_t kFarArguments = 16;                  // bytes: place of the second of two lists' arguments

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
  void declare(Declaration& d) const override { declare_ports(d); }

  void prepare(Environment& e) override {
    check_limits(e);
    const Params& p = e.params();
    steps_ = flood_steps(p.choice("variant"), e.shape("nearest").extent);
    algorithm_ = p.choice("algorithm");
    const Defines mode_defines = modes();
    const auto compute = [&](const char* name, Defines more = {}) {
      more.insert(more.end(), mode_defines.begin(), mode_defines.end());
      return e.compute(fmt::format("distance/distance_transform_{}.glsl", name), std::move(more));
    };
    const Defines::value_type subgroup{kSubgroupSize, std::to_string(e.device().subgroup_size())};
    squares_ = kPackGroup / std::min(e.device().subgroup_size(), kPackSquare);
    pack_ = compute("pack", {subgroup});
    carry_ = compute("carry");
    if (listed_) {
      found_arguments_ = compute("arguments", list("found_arguments", kFoundGroup));
      resolve_ = compute("resolve");
    }
    if (algorithm_ == "banded_exact") {
      prune_ = compute("prune");
      for (uint32_t band = 0; band < 3; ++band)
        envelope_[band] = compute("envelope", {{"BAND", std::to_string(band)}, subgroup});
    }
    if (algorithm_ == "jump_flooding") {
      seed_ = compute("seed");
      flood_[0] = compute("flood", {{"FROM", "nearest"}, {"TO", "other"}});
      flood_[1] = compute("flood", {{"FROM", "other"}, {"TO", "nearest"}});
    }
    if (algorithm_ != "bounded_exact") {
      all_tiles_ = compute("all_tiles");
      arguments_ = compute("arguments", list("arguments", 1));
      return;
    }
    candidates_ = compute("candidates");
    for (const bool far : {false, true})
      search_[far] = compute("search", {{"FAR_SITES", far ? "1" : "0"}, subgroup});
  }

  void record(Context& c) override {
    const ImageShape shape = c.shape("nearest");
    c.section("sites");
    if (reaching_) c.fill("reached", 0);
    for (uint32_t layer = 0; layer < shape.layers; ++layer) find_sites(c, layer);
    c.own_barrier();
    c.dispatch(carry_, divide_up(shape.extent.width, 32), shape.layers);
    c.section("tiles");
    if (algorithm_ == "bounded_exact")
      search(c, shape);
    else
      list_all(c, shape);
    if (algorithm_ == "banded_exact") {
      c.own_barrier();
      c.section("columns");
      const uint32_t spans =
          divide_up(shape.extent.width, kPruneSpan) * divide_up(shape.extent.height, kWord);
      c.dispatch(prune_, divide_up(spans, kPruneGroup), shape.layers);
      c.section("rows");
      sweep(c, shape);
    }
    if (algorithm_ == "jump_flooding") flood(c, shape);
  }

 private:
  static Defines list(const char* arguments, uint32_t per_group) {
    return {{"ARGUMENTS", arguments}, {"PER_GROUP", std::to_string(per_group)}};
  }

  void check_limits(Environment& e) {
    const ImageShape shape = e.shape("nearest");
    const Params& p = e.params();
    const bool depth = e.connected("depth"), geometric = e.connected("geometric");
    depth_aware_ = depth && geometric && p.choice("sites") == "silhouette";
    reach_ = float(0.5 * penumbra_width(e.scene(), p));
    reaching_ = p.choice("algorithm") == "bounded_exact" && reach_ > 0;
    radius_ = std::max(int32_t(p.integer("radius")), int32_t(std::ceil(0.5 * p.number("pixels"))));
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
    c.dispatch(pack_, divide_up(size.width, kWord * squares_), divide_up(size.height, kWord));
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
    c.section("flood");
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
    c.fill("arguments", 0);
    c.fill("candidate_arguments", 0);
    c.clear("nearest", ~0u);
    c.own_barrier();
    for (const Pipeline* pipeline : {&candidates_, &search_[0], &search_[1]}) c.push(*pipeline, radius_);
    c.dispatch(candidates_, divide_up(shape.extent.height, kWord), shape.layers);
    c.own_barrier();
    c.section("search");
    c.dispatch_indirect(search_[0], "candidate_arguments");
    c.dispatch_indirect(search_[1], "candidate_arguments", kFarArguments);
  }

  struct Resolve {  // push constants
    uint32_t layer;
    float reach;  // world units
  };

  std::string algorithm_;
  float reach_ = 0;     // world units
  int32_t radius_ = 1;  // pixels; the least one of bounded_exact
  std::vector<uint32_t> steps_;
  uint32_t squares_ = 1;  // of 32x32 pixels, of a workgroup of distance_transform_pack
  bool depth_aware_ = false, reaching_ = false, listed_ = false;
  Pipeline pack_, found_arguments_, resolve_, carry_, arguments_, all_tiles_;
  Pipeline prune_;
  Pipeline envelope_[3];  // whole rows, sweep of a band, colouring of a band
  Pipeline seed_, flood_[2];
  Pipeline candidates_;
  Pipeline search_[2];  // for small radii, for large ones
};

GNOMON_PASS("distance_transform", DistanceTransform);

}  // namespace
}  // namespace gnomon
