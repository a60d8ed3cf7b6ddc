// Filters that take a penumbra's width for each pixel, with one width everywhere: they are what they are with
// the constant that stands for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "engine/base/error.h"
#include "engine/graph/graph.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

constexpr uint32_t kSize = 64;                  // of the map and of the image, which feeds it
constexpr double kHeight = 8, kLight = 1;       // of the light above the floor; its width
constexpr double kTexel = 2 * kHeight / kSize;  // of the map on the floor: its field of view is 90 degrees

// A floor under a square light that looks straight down.
const Scene& floor_scene() {
  static const Scene scene = [] {
    Scene s;
    analytic::add(s, analytic::square(7), {0, 0, 0});
    analytic::add(s, analytic::square(0.01f), {0.5, 3, 0.5});
    s.cameras.push_back(analytic::camera({2.2, 5.1, 2.7}, {0.1, 0, 0.2}));
    s.lights.push_back(analytic::light(LightType::spot, {0, kHeight, 0}));
    s.lights[0].area = AreaLight{};
    s.lights[0].area->width = s.lights[0].area->height = kLight;
    return s;
  }();
  return scene;
}

// Nearest possible depth in shadow, farthest in light, in squares of `grain` texels.
Image random_depth(int grain, unsigned seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution lit(0.5);
  const uint32_t cells = kSize / uint32_t(grain) + 1;
  std::vector<float> values(size_t(cells) * cells);
  for (float& v : values) v = lit(random) ? 1.0f : 0.0f;
  Image image(kSize, kSize, {"Y"});
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x)
      image.plane(0)[y * kSize + x] = values[y / uint32_t(grain) * cells + x / uint32_t(grain)];
  return image;
}

Image constant(double value) {
  Image image(kSize, kSize, {"Y"});
  std::fill(image.plane(0).begin(), image.plane(0).end(), float(value));
  return image;
}

// `nodes`: graph JSON after the G-buffer, the map (map.value) and the width (width.value), that ends in a
// node `last`.
std::vector<float> run(const Image& depth, double width, const std::string& nodes) {
  const std::string graph = R"({ "schema": 1, "name": "test", "passes": [
    { "id": "gbuffer", "type": "gbuffer" }, { "id": "views", "type": "light_views" },
    { "id": "map", "type": "image_source", "in": { "views": "views.views" }, "params": { "holds": "depth" } },
    { "id": "width", "type": "image_source" }, )" +
                            nodes + R"( ], "outputs": { "visibility": "last.visibility" } })";
  RenderSettings s;
  s.width = s.height = kSize;
  s.images["map"] = std::make_shared<const Image>(depth);
  s.images["width"] = std::make_shared<const Image>(constant(width));
  return hard_shadow::visibility(parse_graph(graph, "test"), floor_scene(), s)[0];
}

// A node with the inputs of every pass that has receivers; `in` and `params` go on from there.
std::string node(const std::string& id, const std::string& type, const std::string& in,
                 const std::string& params) {
  return R"({ "id": ")" + id + R"(", "type": ")" + type +
         R"(", "in": { "depth": "gbuffer.depth", "geometric": "gbuffer.geometric")" + in +
         R"( }, "params": { )" + params + " } }";
}
const std::string kMap = R"(, "shadow_map": "map.value")", kWidth = R"(, "width": "width.value")";

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i) most = std::max(most, double(std::abs(a[i] - b[i])));
  return most;
}
size_t partly_lit(const std::vector<float>& v) {
  return size_t(std::count_if(v.begin(), v.end(), [](float x) { return x > 0 && x < 1; }));
}

TEST(Width, PcfFiltersABoxOfThatManyTexels) {
  const Image depth = random_depth(3, 1);
  for (const int kernel : {1, 3, 7, 15}) {
    const auto is = run(depth, kernel * kTexel, node("last", "pcf", kMap + kWidth, "\"taps\": 16"));
    const auto wanted =
        run(depth, 0,
            node("last", "pcf", kMap, "\"sampling\": \"smooth_box\", \"kernel\": " + std::to_string(kernel)));
    EXPECT_LE(largest_difference(is, wanted), 2e-4) << kernel;
    EXPECT_GT(partly_lit(is), 100u);
  }
}

TEST(Width, PcfOfNoWidthIsThePlainTest) {
  const Image depth = random_depth(3, 2);
  EXPECT_EQ(run(depth, 0, node("last", "pcf", kMap + kWidth, "")),
            run(depth, 0, node("last", "shadow_test", kMap, "")));
}

TEST(Width, RpcfFiltersThatManyTexels) {
  const Image depth = random_depth(5, 3);
  for (const int kernel : {1, 7, 15, 29}) {
    const std::string number = std::to_string(kernel);
    for (const char* reuse : {"true", "false"}) {
      const std::string flags = std::string("\"reuse\": ") + reuse + ", \"kernel\": ";
      const auto is = run(depth, (kernel + 0.3) * kTexel, node("last", "rpcf", kMap + kWidth, flags + "29"));
      EXPECT_EQ(is, run(depth, 0, node("last", "rpcf", kMap, flags + number))) << kernel << ' ' << reuse;
      EXPECT_GT(partly_lit(is), 100u);
    }
  }
}

// A box filter interpolated between texels is the mean over a box at the exact place.
TEST(Width, MomentsOfASummedAreaTableAreThoseOfTheFilteredMap) {
  const Image depth = random_depth(7, 4);
  const std::string moments =
      R"({ "id": "moments", "type": "shadow_moments", "in": { "shadow_map": "map.value" }, "params": { "basis": "variance" } }, )";
  for (const int kernel : {1, 5, 15})
    for (const char* numbers : {"integer", "float"}) {
      const auto is = run(
          depth, kernel * kTexel,
          moments +
              R"({ "id": "table", "type": "summed_area_table", "in": { "source": "moments.moments" }, "params": { "largest_kernel": 16, "numbers": ")" +
              numbers + R"(" } }, )" +
              node("last", "moment_test", kMap + kWidth + R"(, "moments": "table.sums")", ""));
      const auto wanted = run(
          depth, 0,
          moments +
              R"({ "id": "filter", "type": "prefilter", "in": { "source": "moments.moments" }, "params": { "kernel": )" +
              std::to_string(kernel) + " } }, " +
              node("last", "moment_test", kMap + R"(, "moments": "filter.result")", ""));
      EXPECT_LE(largest_difference(is, wanted), 2e-3) << kernel << ' ' << numbers;
      EXPECT_GT(partly_lit(is), 100u);
    }
}

TEST(Width, MomentsNeedATableWithAWidthAndNoneWithout) {
  const Image depth = random_depth(7, 4);
  const std::string moments =
      R"({ "id": "moments", "type": "shadow_moments", "in": { "shadow_map": "map.value" } }, )";
  const std::string table =
      R"({ "id": "table", "type": "summed_area_table", "in": { "source": "moments.moments" } }, )";
  EXPECT_THROW(
      run(depth, 1,
          moments + node("last", "moment_test", kMap + kWidth + R"(, "moments": "moments.moments")", "")),
      Error);
  EXPECT_THROW(
      run(depth, 1, moments + table + node("last", "moment_test", kMap + R"(, "moments": "table.sums")", "")),
      Error);
}

// Pixels that a length of `world` covers at view depth 1.
double pixels_at_one(double world) {
  return kSize * world / (2 * std::tan(0.5 * floor_scene().cameras[0].fov_y));
}

std::string screen_filter(const std::string& type, double world, bool image) {
  const std::string number = std::to_string(pixels_at_one(world));
  return node("hard", "shadow_test", kMap, "") + ", " +
         node("last", type, R"(, "visibility": "hard.visibility")" + (image ? kWidth : std::string()),
              image ? std::string() : "\"reference_depth\": 1, \"width\": " + number);
}

TEST(Width, ScreenFiltersTakeWhatItCoversAtThePixelsDepth) {
  const Image depth = random_depth(4, 5);
  for (const char* type : {"mean_filter", "bilateral_filter"})
    for (const double world : {0.15, 0.3, 0.8}) {  // 2 to 12 pixels
      const auto is = run(depth, world, screen_filter(type, world, true));
      EXPECT_LE(largest_difference(is, run(depth, 0, screen_filter(type, world, false))), 1e-4)
          << type << ' ' << world;
      EXPECT_GT(partly_lit(is), 30u) << type << ' ' << world;
    }
}

// Wider than what the filters with a constant reach: 63 pixels.
TEST(Width, ScreenFiltersReachAsFarAsTheyAreTold) {
  Image depth = constant(1);
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize / 2; ++x) depth.plane(0)[y * kSize + x] = 0;
  for (const char* type : {"mean_filter", "bilateral_filter"}) {
    const auto wide = run(depth, 100, screen_filter(type, 100, true));
    EXPECT_GT(partly_lit(wide), wide.size() * 9 / 10) << type;  // all of the floor, which fills the image
  }
}

TEST(Width, DistancePenumbraTakesTheSilhouettesWidth) {
  const Image depth = random_depth(9, 6);
  constexpr double kPenumbra = 0.5;
  const std::string before =
      node("hard", "revectorize", kMap, R"("mode": "non_conservative")") +
      R"(, { "id": "edt", "type": "distance_transform", "in": { "source": "hard.visibility", "depth": "gbuffer.depth", "geometric": "gbuffer.geometric" },
                                 "params": { "sites": "silhouette", "penumbra": 0.5 } }, )";
  const std::string in =
      R"(, "visibility": "hard.visibility", "nearest": "edt.nearest", "tiles": "edt.tiles", "arguments": "edt.arguments")";
  const auto is = run(depth, kPenumbra, before + node("last", "distance_penumbra", in + kWidth, ""));
  EXPECT_EQ(is, run(depth, 0, before + node("last", "distance_penumbra", in, "")));
  EXPECT_GT(partly_lit(is), 100u);
}

}  // namespace
}  // namespace gnomon
