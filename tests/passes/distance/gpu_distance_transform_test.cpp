// The distance transforms against an oracle in 64-bit integers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "engine/render/context.h"
#include "engine/render/environment.h"
#include "engine/render/renderer.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/distance/gpu_distance_oracle.h"
#include "tests/passes/silent_test.h"
#include "tests/shaders/gpu_kernel_helper.h"
#include "tools/edt.h"

namespace gnomon {
namespace {

using distance_oracle::kNone;
using distance_oracle::NamedMask;

std::shared_ptr<Device> device() { return test::kernel_device(); }

using DistanceTransform = test::Silent;

std::vector<uint32_t> transform(const Image& mask, const EdtSettings& settings) {
  EdtSettings once = settings;
  once.warmup = 0, once.repeat = 1;
  return run_edt(device(), std::make_shared<const Image>(mask), once).nearest;
}

// Pixels whose site is none of the mask's, or whose distance is not the oracle's; `radius` 0: none.
uint64_t count_wrong(const Image& mask, const std::vector<uint32_t>& nearest, int64_t radius = 0) {
  const auto exact = distance_oracle::squared_distances(mask);
  uint64_t wrong = 0;
  for (size_t i = 0; i < exact.size(); ++i) {
    const bool none = exact[i] == kNone || (radius > 0 && exact[i] > radius * radius);
    const auto is = squared_distance(nearest, i, mask.width);
    if (none || !is) {
      wrong += none != !is;
      continue;
    }
    const uint32_t x = nearest[i] & 0xFFFF, y = nearest[i] >> 16;
    wrong += x >= mask.width || y >= mask.height || mask.at(x, y) == 0 || *is != exact[i];
  }
  return wrong;
}

constexpr std::pair<uint32_t, uint32_t> kSizes[] = {{1, 1},   {1, 67},   {83, 1},   {16, 16},
                                                    {31, 33}, {127, 61}, {130, 257}};

TEST_F(DistanceTransform, BandedIsExact) {
  for (const auto& [width, height] : kSizes)
    for (const NamedMask& mask : distance_oracle::masks(width, height))
      EXPECT_EQ(count_wrong(mask.image, transform(mask.image, {.algorithm = "banded_exact"})), 0u)
          << mask.name << ' ' << width << 'x' << height;
}

TEST_F(DistanceTransform, BoundedIsExactWithinItsRadiusAndNoneBeyond) {
  for (const uint32_t radius : {1u, 17u, 32u, 300u})
    for (const auto& [width, height] : kSizes) {
      if (radius != 32 && width * height < 1000) continue;
      for (const NamedMask& mask : distance_oracle::masks(width, height))
        EXPECT_EQ(
            count_wrong(mask.image, transform(mask.image, {.algorithm = "bounded_exact", .radius = radius}),
                        radius),
            0u)
            << mask.name << ' ' << width << 'x' << height << ", radius " << radius;
    }
}

TEST_F(DistanceTransform, LongImagesAreExact) {
  for (const auto& [width, height] : {std::pair{16384u, 40u}, {2u, 16381u}, {6007u, 5u}}) {
    const Image ends = distance_oracle::make_mask(
        width, height,
        [=, w = width, h = height](uint32_t x, uint32_t y) { return x + 1 == w && y + 1 == h; });
    const Image sparse = distance_oracle::random_mask(width, height, 2e-4, 5);
    const Image dense = distance_oracle::random_mask(width, height, 0.3, 6);
    for (const Image* mask : {&ends, &sparse, &dense}) {
      EXPECT_EQ(count_wrong(*mask, transform(*mask, {.algorithm = "banded_exact"})), 0u) << width;
      // Where the two searches meet, beyond that, and the most.
      for (const uint32_t radius : {512u, 513u, 700u, 16384u})
        EXPECT_EQ(
            count_wrong(*mask, transform(*mask, {.algorithm = "bounded_exact", .radius = radius}), radius),
            0u)
            << width << ", radius " << radius;
    }
  }
}

TEST_F(DistanceTransform, EveryValueButZeroIsASite) {
  const float values[] = {0.0f, -0.0f, 1e-40f, -2.0f, 0.5f, std::numeric_limits<float>::infinity()};
  Image mask(90, 70, {"Y"}), ones(90, 70, {"Y"});
  for (size_t i = 0; i < mask.data.size(); ++i) {
    mask.data[i] = i % 397 == 0 ? values[i / 397 % std::size(values)] : 0;
    ones.data[i] = mask.data[i] != 0;
  }
  EXPECT_EQ(count_wrong(ones, transform(mask, {.algorithm = "banded_exact"})), 0u);
}

TEST_F(DistanceTransform, RepeatsBitForBit) {
  const auto mask = std::make_shared<const Image>(distance_oracle::random_mask(403, 301, 0.003, 11));
  for (const char* algorithm : {"banded_exact", "bounded_exact", "jump_flooding"}) {
    const auto first = run_edt(device(), mask, {.algorithm = algorithm, .warmup = 0}).nearest;
    EXPECT_EQ(first, run_edt(device(), mask, {.algorithm = algorithm, .warmup = 3}).nearest) << algorithm;
  }
}

TEST_F(DistanceTransform, TallImagesAreDoneInStripes) {
  // A stripe holds 2^24 pixels.
  const Image mask = distance_oracle::random_mask(8192, 2080, 1e-5, 3);
  EXPECT_EQ(count_wrong(mask, transform(mask, {.algorithm = "banded_exact"})), 0u);
}

TEST_F(DistanceTransform, ListsMayBeLongerThanADispatchIsWide) {
  const Image mask = distance_oracle::random_mask(16384, 1040, 1e-3, 4);  // 66560 tiles, nearly all in reach
  EXPECT_EQ(count_wrong(mask, transform(mask, {.algorithm = "bounded_exact"}), 32), 0u);
}

TEST_F(DistanceTransform, JumpFloodingIsNearlyExactAndItsVariantsImproveIt) {
  const Image mask = distance_oracle::random_mask(512, 384, 0.004, 1);
  const auto exact = transform(mask, {.algorithm = "banded_exact"});
  const auto error = [&](const char* variant) {
    const auto nearest = transform(mask, {.algorithm = "jump_flooding", .variant = variant});
    return edt_error(nearest, exact, mask.width);
  };
  const EdtError jfa = error("jfa"), squared = error("jfa_squared");
  EXPECT_GT(jfa.wrong, 0u);  // otherwise nothing is tested
  EXPECT_LT(jfa.wrong, 512 * 384 / 500u);
  EXPECT_LT(jfa.largest, 4);
  EXPECT_LE(error("one_plus_jfa").wrong, jfa.wrong);
  EXPECT_LE(error("jfa_plus_one").wrong, jfa.wrong);
  EXPECT_LT(squared.wrong, jfa.wrong);
  const Image empty(33, 20, {"Y"});
  for (const uint32_t site : transform(empty, {.algorithm = "jump_flooding"})) ASSERT_EQ(site, kNoSite);
}

// Macedo 2018, ch. 4.2.2: pixels that differ from one of their eight neighbours inside the image.
Image silhouette_of(const Image& image) {
  return distance_oracle::make_mask(image.width, image.height, [&](uint32_t x, uint32_t y) {
    for (int64_t j = -1; j <= 1; ++j)
      for (int64_t i = -1; i <= 1; ++i) {
        const int64_t u = x + i, v = y + j;
        if (u < 0 || v < 0 || u >= image.width || v >= image.height) continue;
        if (image.at(uint32_t(u), uint32_t(v)) != image.at(x, y)) return true;
      }
    return false;
  });
}

TEST_F(DistanceTransform, SilhouettesAreTheDifferingPixels) {
  for (const auto& [width, height] : kSizes)
    for (NamedMask& mask : distance_oracle::masks(width, height)) {
      for (size_t i = 0; i < mask.image.data.size(); i += 7)
        mask.image.data[i] *= 0.25f;  // more than two values
      const auto nearest = transform(mask.image, {.algorithm = "banded_exact", .sites = "silhouette"});
      EXPECT_EQ(count_wrong(silhouette_of(mask.image), nearest), 0u)
          << mask.name << ' ' << width << 'x' << height;
    }
}

// Marks the pixels of the tiles in a list: one workgroup a tile, by an indirect dispatch, as the users of
// lists do.
class MarkTiles : public Pass {
 public:
  void declare(Declaration& d) const override {
    d.summary("Marks tiles.");
    d.input_buffer("tiles", Access::storage_read, "tiles");
    d.input_buffer("arguments", Access::storage_read | Access::indirect, "their dispatch");
    d.output("marked", Access::storage_write | Access::transfer_write, false,
             {d.setting().viewport, 1, 1, VK_FORMAT_R32_UINT}, "times that a pixel's tile is listed");
  }
  void prepare(Environment& e) override {
    const std::filesystem::path file = test::scratch_folder() / "mark_tiles.glsl";
    write_text(file, R"(const int TILE = 16;
#include "lib/tiles.glsl"
layout(local_size_x = 16, local_size_y = 16) in;
void main() {
  uint index = tile_index(gl_WorkGroupID, gl_NumWorkGroups);
  if (index >= arguments[3]) return;
  Tile tile = unpack_tile(tiles[index]);
  ivec2 at = tile.origin + ivec2(gl_LocalInvocationID.xy);
  if (all(lessThan(at, imageSize(marked)))) imageStore(marked, at, uvec4(1u));
}
)");
    pipeline_ = e.compute(file.string());
  }
  void record(Context& c) override {
    c.clear("marked", 0);
    c.own_barrier();
    c.dispatch_indirect(pipeline_, "arguments");
  }

 private:
  Pipeline pipeline_;
};
GNOMON_PASS("test_mark_tiles", MarkTiles);

std::vector<uint32_t> marked_tiles(const Image& mask, const std::string& params) {
  const std::string text = R"({ "schema": 1, "name": "tiles", "passes": [
    { "id": "mask", "type": "image_source" },
    { "id": "edt", "type": "distance_transform", "in": { "source": "mask.value" }, "params": )" +
                           params + R"( },
    { "id": "mark", "type": "test_mark_tiles", "in": { "tiles": "edt.tiles", "arguments": "edt.arguments" } } ],
    "outputs": { "marked": "mark.marked" } })";
  RenderSettings settings;
  settings.width = mask.width, settings.height = mask.height;
  settings.images["mask"] = std::make_shared<const Image>(mask);
  const Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {1.5, 7, 1}));
  Renderer renderer(device(), std::make_shared<Scene>(scene), parse_graph(text, "tiles"), settings);
  renderer.render(TimingMode::none);
  renderer.render(TimingMode::none);  // lists begin anew
  return renderer.read_words("marked");
}

TEST_F(DistanceTransform, ListsTheTilesThatHoldAPixelWithASite) {
  constexpr int64_t kTile = 16, kRadius = 20;
  const Image mask = distance_oracle::random_mask(301, 203, 0.0002, 8);
  const auto exact = distance_oracle::squared_distances(mask);
  const auto marked =
      marked_tiles(mask, R"({ "algorithm": "bounded_exact", "radius": )" + std::to_string(kRadius) + " }");
  uint64_t listed = 0;
  for (int64_t ty = 0; ty < mask.height; ty += kTile)
    for (int64_t tx = 0; tx < mask.width; tx += kTile) {
      bool wanted = false;
      for (int64_t y = ty; y < std::min<int64_t>(ty + kTile, mask.height); ++y)
        for (int64_t x = tx; x < std::min<int64_t>(tx + kTile, mask.width); ++x)
          wanted = wanted || exact[size_t(y * mask.width + x)] <= kRadius * kRadius;
      EXPECT_EQ(marked[size_t(ty * mask.width + tx)] != 0, wanted) << tx << ' ' << ty;
      listed += wanted;
    }
  EXPECT_GT(listed, 5u);
  EXPECT_LT(listed, 200u);
}

TEST_F(DistanceTransform, ListsAllTilesWhenUnbounded) {
  for (const uint32_t mark : marked_tiles(Image(100, 33, {"Y"}), R"({ "algorithm": "banded_exact" })"))
    ASSERT_EQ(mark, 1u);
}

// A square casts its shadow on the plane below, and a depth edge of the square crosses it in the image.
Scene shadow_scene() { return analytic::square_over_plane(analytic::light(LightType::spot, {1.5, 7, 1})); }

const char* const kDepthGraph = R"({ "schema": 1, "name": "depth", "passes": [
  { "id": "gbuffer", "type": "gbuffer" }, { "id": "views", "type": "light_views" },
  { "id": "map", "type": "shadow_map", "in": { "views": "views.views" }, "params": { "size": 256 } },
  { "id": "hard", "type": "shadow_test",
    "in": { "depth": "gbuffer.depth", "geometric": "gbuffer.geometric", "shadow_map": "map.depth" } },
  { "id": "edt", "type": "distance_transform", "params": { "sites": "silhouette", PARAMS },
    "in": { "source": "hard.visibility", "depth": "gbuffer.depth", "geometric": "gbuffer.geometric" } } ],
  "outputs": { "nearest": "edt.nearest", "visibility": "hard.visibility" } })";

struct DepthRun {
  Image visibility, depth;
  std::vector<uint32_t> nearest;
};

DepthRun depth_run(const std::string& params) {
  std::string text = kDepthGraph;
  text.replace(text.find("PARAMS"), 6, params);
  RenderSettings settings;
  settings.width = 200, settings.height = 150;
  settings.captures = {"gbuffer.depth"};
  Renderer renderer(device(), std::make_shared<Scene>(shadow_scene()), parse_graph(text, "depth"), settings);
  renderer.render(TimingMode::none);
  return {renderer.read("visibility"), renderer.read("gbuffer.depth"), renderer.read_words("nearest")};
}

TEST_F(DistanceTransform, DepthTellsShadowEdgesFromDepthEdges) {
  const DepthRun run = depth_run(R"("algorithm": "banded_exact")");
  const Image all = silhouette_of(run.visibility);
  uint64_t sites = 0, candidates = 0;
  for (size_t i = 0; i < run.nearest.size(); ++i) {
    candidates += all.data[i] != 0;
    if (run.nearest[i] == kNoSite || squared_distance(run.nearest, i, 200) != 0) continue;
    ++sites;
    EXPECT_NE(all.data[i], 0.0f);
    EXPECT_GT(run.depth.data[i], 0.0f) << "the background is no site";
  }
  EXPECT_GT(sites, 50u);
  EXPECT_LT(sites, candidates);
}

TEST_F(DistanceTransform, ReachGivesARadiusThatCutsNothingWithinItOff) {
  const DepthRun exact = depth_run(R"("algorithm": "banded_exact")");
  const DepthRun bounded = depth_run(R"("algorithm": "bounded_exact", "penumbra": 0.6)");
  uint64_t kept = 0, cut = 0;
  int64_t farthest = 0, nearest_cut = INT64_MAX;
  for (size_t i = 0; i < exact.nearest.size(); ++i) {
    const auto wanted = squared_distance(exact.nearest, i, 200),
               is = squared_distance(bounded.nearest, i, 200);
    ASSERT_TRUE(wanted.has_value());
    if (is) {
      ASSERT_EQ(*is, *wanted);
      farthest = std::max(farthest, *is);
      ++kept;
    } else {
      nearest_cut = std::min(nearest_cut, *wanted);
      ++cut;
    }
  }
  EXPECT_GT(kept, 500u);
  EXPECT_GT(cut, 500u);
  EXPECT_LT(farthest, nearest_cut);
  // Field of view 2 atan(h / 2 f): a length r at view depth z spans f r / z pixels.
  const Scene scene = shadow_scene();
  const double focal = 75 / std::tan(scene.cameras[0].fov_y / 2);
  for (size_t i = 0; i < exact.nearest.size(); ++i) {
    if (squared_distance(exact.nearest, i, 200) != 0) continue;
    const double z = scene.cameras[0].near / exact.depth.data[i];
    EXPECT_GE(double(nearest_cut), std::pow(focal * 0.3 / z, 2));
  }
}

TEST_F(DistanceTransform, ReachWithoutDepthIsAnError) {
  EXPECT_THROW(marked_tiles(Image(8, 8, {"Y"}), R"({ "algorithm": "bounded_exact", "penumbra": 2.0 })"),
               Error);
}

// 8192 x 8192 takes minutes: GNOMON_SLOW_TESTS=1.
TEST_F(DistanceTransform, LargeImagesAreExact) {
  if (std::getenv("GNOMON_SLOW_TESTS") == nullptr) GTEST_SKIP() << "set GNOMON_SLOW_TESTS";
  constexpr uint64_t memory = uint64_t{4} << 30;  // bytes
  for (const double density : {0.3, 1e-3, 1e-7}) {
    const Image mask = distance_oracle::random_mask(8192, 8192, density, 2);
    EXPECT_EQ(count_wrong(mask, transform(mask, {.algorithm = "banded_exact", .memory = memory})), 0u)
        << density;
    EXPECT_EQ(count_wrong(mask, transform(mask, {.algorithm = "bounded_exact", .memory = memory}), 32), 0u)
        << density;
  }
}

}  // namespace
}  // namespace gnomon
