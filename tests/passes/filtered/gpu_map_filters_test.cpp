// Filters of shadow tests (PCF, RPCF) on hand-made shadow maps, against plain models of their definitions.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/graph/graph.h"
#include "engine/light/light_view.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/parameter_name.h"
#include "tests/passes/hard/hard_shadow_run.h"
#include "tests/shaders/gpu_revectorization_helper.h"

namespace gnomon {
namespace {

using test::VisibilityMap;
constexpr uint32_t kSize = 48;  // of the map and of the image, which feeds it

// A floor under a directional light from above, whose map is as wide as the floor; the blocker only sets the
// depth range.
const Scene& floor_scene() {
  static const Scene scene = [] {
    Scene s;
    analytic::add(s, analytic::square(5), {0, 0, 0});
    analytic::add(s, analytic::square(0.01f), {4.9, 3, 4.9});
    s.cameras.push_back(analytic::camera({2.2, 6.1, 2.7}, {0.1, 0, 0.2}));
    s.lights.push_back(analytic::light(LightType::directional, {0, 9, 0}));
    return s;
  }();
  return scene;
}

// Texels in shadow with the given probability, in squares of `grain` texels.
VisibilityMap random_map(double shadow, int grain, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  const int cells = int(kSize) / grain + 1;
  std::vector<bool> dark(size_t(cells * cells));
  for (size_t i = 0; i < dark.size(); ++i) dark[i] = uniform(random) < shadow;
  VisibilityMap map;
  for (int y = 0; y < int(kSize); ++y) {
    map.rows.emplace_back();
    for (int x = 0; x < int(kSize); ++x)
      map.rows.back() += dark[size_t(y / grain * cells + x / grain)] ? '#' : '.';
  }
  return map;
}

// Nearest possible depth in shadow, farthest in light.
std::shared_ptr<const Image> depth_of(const VisibilityMap& map) {
  Image image(kSize, kSize, {"Y"});
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x)
      image.plane(0)[y * kSize + x] = map.lit(int(x), int(y)) ? 1.0f : 0.0f;
  return std::make_shared<Image>(std::move(image));
}

std::vector<float> filtered(const VisibilityMap& map, const std::string& type, const std::string& params) {
  const std::string graph = R"({ "schema": 1, "name": "test", "passes": [
    { "id": "gbuffer", "type": "gbuffer" }, { "id": "views", "type": "light_views" },
    { "id": "map", "type": "image_source", "in": { "views": "views.views" }, "params": { "holds": "depth" } },
    { "id": "filter", "type": ")" +
                            type + R"(", "params": {)" + params + R"(},
      "in": { "depth": "gbuffer.depth", "geometric": "gbuffer.geometric", "shadow_map": "map.value" } } ],
    "outputs": { "visibility": "filter.visibility" } })";
  RenderSettings s;
  s.width = s.height = kSize;
  s.images["map"] = depth_of(map);
  return hard_shadow::visibility(parse_graph(graph, "test"), floor_scene(), s)[0];
}

// Where pixels fall in the map, in texels; those whose texel rounding could change are left out.
struct Place {
  uint32_t pixel;
  double x, y;
};
std::vector<Place> places() {
  const Reference reference = [] {
    ReferenceSettings r;
    r.width = r.height = kSize;
    return ReferenceTracer(floor_scene()).trace(r);
  }();
  const LightView face = light_views(floor_scene(), kSize, 0).front();
  const glm::dvec3 eye(floor_scene().cameras[0].world_from_camera[3]);
  std::vector<Place> all;
  for (uint32_t i = 0; i < reference.depth.size(); ++i) {
    if (reference.domain[0][i] != Reference::counted) continue;
    const glm::dvec3 q(face.light_from_world * glm::dvec4(eye + glm::dvec3(reference.position[i]), 1));
    const Place p{i, (0.5 + 0.5 * q.x / face.half_width) * kSize,
                  (0.5 - 0.5 * q.y / face.half_height) * kSize};
    const auto off = [](double a) { return std::abs(a - std::round(a)); };
    if (off(p.x) > 1e-3 && off(p.y) > 1e-3) all.push_back(p);
  }
  return all;
}

double box(const VisibilityMap& map, const Place& p, int kernel) {
  double sum = 0;
  for (int y = 0; y < kernel; ++y)
    for (int x = 0; x < kernel; ++x)
      sum += map.lit(int(std::floor(p.x)) + x - kernel / 2, int(std::floor(p.y)) + y - kernel / 2);
  return sum / (kernel * kernel);
}

double overlap(double texel, double begin, double width) {
  return std::max(0.0, std::min(texel + 1, begin + width) - std::max(texel, begin));
}

double smooth_box(const VisibilityMap& map, const Place& p, int kernel) {
  double sum = 0;
  const double left = p.x - 0.5 * kernel, top = p.y - 0.5 * kernel;
  for (int y = int(std::floor(top)); y <= int(top + kernel); ++y)
    for (int x = int(std::floor(left)); x <= int(left + kernel); ++x)
      sum += overlap(x, left, kernel) * overlap(y, top, kernel) * map.lit(x, y);
  return sum / (kernel * kernel);
}

double rpcf(const VisibilityMap& map, const Place& p, int kernel, int max_size) {
  double sum = 0;
  for (int y = 0; y < kernel; ++y)
    for (int x = 0; x < kernel; ++x)
      sum += test::revectorize_by_equations(map, {float(p.x + x - kernel / 2), float(p.y + y - kernel / 2)},
                                            max_size)
                 .filtered;
  return sum / (kernel * kernel);
}

TEST(PercentageCloserFilter, IsTheMeanOfTheTestsInTheBox) {
  const auto at = places();
  ASSERT_GT(at.size(), 1000u);
  for (const int kernel : {1, 3, 7, 63}) {
    const VisibilityMap map = random_map(0.4, 1, unsigned(kernel));
    const std::string params = "\"kernel\": " + std::to_string(kernel);
    const auto plain = filtered(map, "pcf", params);
    const auto smooth = filtered(map, "pcf", params + R"(, "sampling": "smooth_box")");
    for (const Place& p : at) {
      ASSERT_NEAR(plain[p.pixel], box(map, p, kernel), 1e-5) << kernel;
      ASSERT_NEAR(smooth[p.pixel], smooth_box(map, p, kernel), 2e-4) << kernel;
    }
  }
}

// Many samples of the disc: its share in shadow, to the accuracy of 1024 samples of a half plane.
TEST(PercentageCloserFilter, VogelCoversTheDisc) {
  VisibilityMap map = random_map(0, 1, 0);
  for (auto& row : map.rows) row.replace(0, kSize / 2, kSize / 2, '#');
  const int kernel = 15;
  const auto v =
      filtered(map, "pcf", R"("kernel": 15, "sampling": "vogel", "samples": 1024, "rotate": false)");
  for (const Place& p : places()) {
    const double d = std::clamp((p.x - kSize / 2.0) / (0.5 * kernel), -1.0, 1.0);
    const double lit = 1 - (std::acos(d) - d * std::sqrt(1 - d * d)) / M_PI;
    ASSERT_NEAR(v[p.pixel], lit, 0.01) << p.x;
  }
}

TEST(PercentageCloserFilter, RefusesEvenKernels) {
  EXPECT_THROW(filtered(random_map(0, 1, 0), "pcf", "\"kernel\": 4"), Error);
}

struct RpcfCase {
  double shadow;
  int grain, kernel, max_size;
};
void PrintTo(const RpcfCase& c, std::ostream* out) {
  *out << "kernel " << c.kernel << " size " << c.max_size << " grain " << c.grain << " shadow "
       << 100 * c.shadow << " percent";
}
class RevectorizationBasedFilter : public testing::TestWithParam<RpcfCase> {};
INSTANTIATE_TEST_SUITE_P(All, RevectorizationBasedFilter,
                         testing::Values(RpcfCase{0.5, 1, 1, 16}, RpcfCase{0.3, 3, 1, 255},
                                         RpcfCase{0.2, 1, 3, 16}, RpcfCase{0.5, 7, 7, 16},
                                         RpcfCase{0.4, 4, 7, 3}, RpcfCase{0.3, 9, 7, 255},
                                         RpcfCase{0.5, 5, 15, 1}, RpcfCase{0.1, 11, 29, 16},
                                         RpcfCase{0.6, 13, 63, 31}),
                         test::ParameterName());

std::string rpcf_params(const RpcfCase& c, bool reuse, bool list) {
  return "\"kernel\": " + std::to_string(c.kernel) + ", \"max_size\": " + std::to_string(c.max_size) +
         ", \"reuse\": " + (reuse ? "true" : "false") + ", \"list\": " + (list ? "true" : "false");
}

TEST_P(RevectorizationBasedFilter, IsTheMeanOfTheRevectorizedSamples) {
  const RpcfCase& c = GetParam();
  const VisibilityMap map = random_map(c.shadow, c.grain, 17);
  const auto v = filtered(map, "rpcf", rpcf_params(c, true, true));
  size_t fractional = 0;
  for (const Place& p : places()) {
    if (c.kernel > 15 && p.pixel % 7 != 0) continue;  // the model is slow
    ASSERT_NEAR(v[p.pixel], rpcf(map, p, c.kernel, c.max_size), 2e-3) << p.x << ' ' << p.y;
    fractional += v[p.pixel] > 0 && v[p.pixel] < 1;
  }
  EXPECT_GT(fractional, 20u);
}

TEST_P(RevectorizationBasedFilter, ReuseAndListingChangeNoBit) {
  const RpcfCase& c = GetParam();
  const VisibilityMap map = random_map(c.shadow, c.grain, 23);
  const auto naive = filtered(map, "rpcf", rpcf_params(c, false, false));
  EXPECT_EQ(filtered(map, "rpcf", rpcf_params(c, true, true)), naive);
  EXPECT_EQ(filtered(map, "rpcf", rpcf_params(c, false, true)), naive);
}

}  // namespace
}  // namespace gnomon
