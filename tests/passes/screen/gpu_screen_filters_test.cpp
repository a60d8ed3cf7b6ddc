// The separable filters of a visibility image against plain models of their definitions.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/graph/graph.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/parameter_name.h"
#include "tests/passes/hard/hard_shadow_run.h"

namespace gnomon {
namespace {

constexpr uint32_t kWidth = 173, kHeight = 109;  // neither a multiple of any tile
constexpr double kMaxHalf = 31;                  // pixels

// A floor that does not fill the image, two squares above it and one on it: edges of every kind, all planar.
const Scene& steps_scene() {
  static const Scene scene = [] {
    Scene s;
    analytic::add(s, analytic::square(5), {0, 0, 0});
    analytic::add(s, analytic::square(1), {-1.5, 2, -1});
    analytic::add(s, analytic::square(0.8f), {1.5, 1, 1});
    analytic::add(s, analytic::square(0.7f, false), {0.2, 1.5, 2.5});  // faces away from the light
    s.materials.back().double_sided = false;
    s.cameras.push_back(analytic::camera({4, 6, 5}, {0, 0, 0}));
    s.lights.push_back(analytic::light(LightType::directional, {0.5, 9, 1}));
    return s;
  }();
  return scene;
}

const Reference& reference() {
  static const Reference r = [] {
    ReferenceSettings s;
    s.width = kWidth, s.height = kHeight;
    return ReferenceTracer(steps_scene()).trace(s);
  }();
  return r;
}

using Plane = std::vector<float>;

// Blobs of light and shadow with values between, and large areas of plain 0 and 1.
Plane blobs(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  Plane v(kWidth * kHeight, 1.0f);
  for (int blob = 0; blob < 6; ++blob) {
    const float cx = uniform(random) * kWidth * 0.6f, cy = uniform(random) * kHeight,
                r = 3 + 12 * uniform(random);
    for (uint32_t y = 0; y < kHeight; ++y)
      for (uint32_t x = 0; x < kWidth; ++x) {
        const float d = std::hypot(float(x) - cx, float(y) - cy) / r;
        if (d < 1) v[y * kWidth + x] = std::min(v[y * kWidth + x], d < 0.5f ? 0.0f : uniform(random));
      }
  }
  return v;
}

struct Filter {
  std::string type;
  double width = 15, reference_depth = 9;  // pixels; world units
  double depth_tolerance = 1e-3, range_tolerance = 0.01;
};
void PrintTo(const Filter& f, std::ostream* out) { *out << f.type << ' ' << f.width; }

Plane on_device(const Filter& f, const Plane& source) {
  Image image(kWidth, kHeight, {"Y"});
  std::copy(source.begin(), source.end(), image.plane(0).begin());
  const std::string extra =
      f.type == "bilateral_filter" ? ", \"range_tolerance\": " + std::to_string(f.range_tolerance) : "";
  const std::string graph = R"({ "schema": 1, "name": "test", "passes": [
    { "id": "gbuffer", "type": "gbuffer" }, { "id": "source", "type": "image_source" },
    { "id": "filter", "type": ")" +
                            f.type + R"(", "params": { "width": )" + std::to_string(f.width) +
                            ", \"reference_depth\": " + std::to_string(f.reference_depth) + extra + R"( },
      "in": { "depth": "gbuffer.depth", "geometric": "gbuffer.geometric", "visibility": "source.value" } } ],
    "outputs": { "visibility": "filter.visibility" } })";
  RenderSettings s;
  s.width = kWidth, s.height = kHeight;
  s.images["source"] = std::make_shared<Image>(std::move(image));
  return hard_shadow::visibility(parse_graph(graph, "test"), steps_scene(), s)[0];
}

// ------------------------------------------------------------------------------------------------ models

bool receives(uint32_t i) {
  const uint8_t domain = reference().domain[0][i];
  return domain != Reference::no_geometry && domain != Reference::faces_away;
}

bool edge(const Filter& f, uint32_t a, uint32_t b) {
  if (!receives(a) || !receives(b)) return true;
  const Reference& r = reference();
  const auto off = [&](uint32_t p, uint32_t q) {
    const double d = glm::dot(glm::dvec3(r.normal[p]), glm::dvec3(r.position[q]) - glm::dvec3(r.position[p]));
    return std::abs(d) > f.depth_tolerance * r.depth[p];
  };
  return off(a, b) && off(b, a);
}

double half_width(const Filter& f, uint32_t i) {
  return std::clamp(0.5 * (f.width * f.reference_depth / double(reference().depth[i]) - 1), 0.0, kMaxHalf);
}

// One direction; `at(k)`: the pixel k steps along the line, or nothing outside the image.
template <class At>
double mean_at(const Filter& f, const Plane& v, uint32_t centre, const At& at) {
  const double half = half_width(f, centre);
  double sum = v[centre], weight = 1;
  for (const int way : {-1, 1})
    for (int k = 1; k <= std::ceil(half); ++k) {
      const auto pixel = at(way * k), before = at(way * (k - 1));
      if (!pixel || edge(f, *pixel, *before)) break;
      const double w = std::min(1.0, half + 1 - k);
      sum += w * v[*pixel], weight += w;
    }
  return sum / weight;
}

template <class At>
double bilateral_at(const Filter& f, const Plane& v, uint32_t centre, const At& at) {
  if (!receives(centre)) return v[centre];
  const Reference& r = reference();
  const double half = half_width(f, centre), sigma = std::max(half, 0.5) / 2;
  double sum = v[centre], weight = 1;
  for (const int way : {-1, 1})
    for (int k = 1; k <= std::ceil(half); ++k) {
      const auto pixel = at(way * k);
      if (!pixel || !receives(*pixel)) continue;
      const glm::dvec3 way_there = glm::dvec3(r.position[*pixel]) - glm::dvec3(r.position[centre]);
      const double off =
          glm::dot(glm::dvec3(r.normal[centre]), way_there) / (f.range_tolerance * r.depth[centre]);
      const double w = std::min(1.0, half + 1 - k) * std::exp(-0.5 * (k * k / (sigma * sigma) + off * off));
      sum += w * v[*pixel], weight += w;
    }
  return sum / weight;
}

Plane model(const Filter& f, const Plane& source) {
  Plane v = source;
  for (const bool along_y : {false, true}) {
    const Plane before = v;
    for (uint32_t y = 0; y < kHeight; ++y)
      for (uint32_t x = 0; x < kWidth; ++x) {
        const auto at = [&](int k) -> std::optional<uint32_t> {
          const int px = int(x) + (along_y ? 0 : k), py = int(y) + (along_y ? k : 0);
          if (px < 0 || py < 0 || px >= int(kWidth) || py >= int(kHeight)) return std::nullopt;
          return uint32_t(py) * kWidth + uint32_t(px);
        };
        const uint32_t i = y * kWidth + x;
        v[i] = float(f.type == "mean_filter" ? mean_at(f, before, i, at) : bilateral_at(f, before, i, at));
      }
  }
  return v;
}

class ScreenFilter : public testing::TestWithParam<Filter> {};
INSTANTIATE_TEST_SUITE_P(All, ScreenFilter,
                         testing::Values(Filter{"mean_filter", 1}, Filter{"mean_filter", 7},
                                         Filter{"mean_filter", 15}, Filter{"mean_filter", 31},
                                         Filter{"mean_filter", 63, 20}, Filter{"bilateral_filter", 1},
                                         Filter{"bilateral_filter", 7}, Filter{"bilateral_filter", 15},
                                         Filter{"bilateral_filter", 63, 20}),
                         test::ParameterName());

TEST_P(ScreenFilter, IsItsDefinition) {
  const Filter f = GetParam();
  const Plane source = blobs(5), v = on_device(f, source), expected = model(f, source);
  size_t changed = 0;
  for (uint32_t i = 0; i < v.size(); ++i) {
    ASSERT_NEAR(v[i], expected[i], 1e-4) << i % kWidth << ", " << i / kWidth;
    changed += v[i] != source[i];
  }
  EXPECT_GE(changed, f.width > 1 ? 500u : 0u);
}

TEST_P(ScreenFilter, LeavesPlainImagesAlone) {
  for (const float value : {0.0f, 1.0f})
    for (const float v : on_device(GetParam(), Plane(kWidth * kHeight, value))) ASSERT_EQ(v, value);
}

}  // namespace
}  // namespace gnomon
