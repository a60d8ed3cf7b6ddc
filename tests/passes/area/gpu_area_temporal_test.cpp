// Soft shadows from one light sample a frame: what is kept from frame to frame, and what must not be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/engine/scene/moving_scenes.h"
#include "tests/engine/truth/analytic_scenes.h"
#include "tests/passes/hard/hard_shadow_run.h"
#include "tests/passes/silent_test.h"

namespace gnomon {
namespace {

using analytic::Mover;
using hard_shadow::device;
using hard_shadow::settings;
using Plane = std::vector<float>;

constexpr double kFrame = 1.0 / 32;  // seconds, exact
constexpr int64_t kMap = 256;        // texels
constexpr int64_t kMany = 256;       // samples that stand for the truth

AreaLight square_light(double side) {
  AreaLight area;
  area.width = area.height = side;
  return area;
}

// A square light above a square blocker (instance 1) and a plane.
Scene overhead(const std::optional<AreaLight>& area) {
  Light light = analytic::light(LightType::spot, {0, 6, 0});
  light.area = area;
  return analytic::square_over_plane(light);
}

RenderSettings capturing() {
  RenderSettings s = settings(true);
  s.frame_seconds = kFrame;
  s.captures = {"light.shadow_buffer"};
  return s;
}

Values small_map(Values set) {
  set.emplace("shadow_map", kMap);
  return set;
}

// A sequence of frames and what the last of them left.
class Sequence {
 public:
  explicit Sequence(const Scene& scene, const Values& set = {})
      : renderer_(device(), std::make_shared<Scene>(scene),
                  load_graph(find_graph("area_temporal"), small_map(set)), capturing()) {
    renderer_.play();
  }
  void play(int frames) {
    for (int i = 0; i < frames; ++i) renderer_.render(TimingMode::none);
    const Image buffer = renderer_.read("light.shadow_buffer");
    shadowed = plane(buffer, "R"), tests = plane(buffer, "G"), depth = plane(buffer, "B");
    const Image image = renderer_.read("visibility");
    visibility.assign(image.plane(size_t{0}).begin(), image.plane(size_t{0}).end());
    for (const float v : visibility) ASSERT_TRUE(v >= 0.0f && v <= 1.0f) << v;
  }
  double seconds() const { return renderer_.seconds(); }

  Plane shadowed, tests, depth, visibility;  // of light 0

 private:
  static Plane plane(const Image& image, const std::string& channel) {
    const auto values = image.plane(channel);
    return Plane(values.begin(), values.end());
  }
  Renderer renderer_;
};

Plane uniform(const Scene& scene, int64_t samples) {
  Scene still = scene;
  still.animation = nullptr;
  return hard_shadow::visibility("area_uniform", still, settings(true),
                                 small_map({{"samples", samples}, {"pattern", "sobol"}}))[0];
}

double rmse(const Plane& a, const Plane& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / double(a.size()));
}

size_t count(const Plane& plane, float value) {
  return size_t(std::count(plane.begin(), plane.end(), value));
}

class AreaTemporal : public test::Silent {};

TEST_F(AreaTemporal, AStillViewAccumulatesTheAverageOfTheSamplesBitForBit) {
  AreaLight disc = square_light(1.5);
  disc.shape = AreaLight::Shape::disc;
  for (const AreaLight& area : {square_light(1), disc}) {
    const Scene scene = overhead(area);
    Sequence sequence(scene);
    int played = 0;
    for (const int frames : {1, 2, 23}) {
      sequence.play(frames - played);
      played = frames;
      const Plane wanted = uniform(scene, frames);
      size_t inside = 0, penumbra = 0;
      for (size_t i = 0; i < wanted.size(); ++i) {
        if (sequence.tests[i] == 0.0f) continue;
        ++inside;
        ASSERT_EQ(sequence.tests[i], float(frames)) << i;
        ASSERT_EQ((sequence.tests[i] - sequence.shadowed[i]) / sequence.tests[i], wanted[i]) << i;
        penumbra += wanted[i] > 0.0f && wanted[i] < 1.0f;
      }
      EXPECT_GT(inside, wanted.size() / 2);
      EXPECT_TRUE(frames == 1 || penumbra > 100) << penumbra;
    }
  }
}

TEST_F(AreaTemporal, AfterThirtyFramesTheErrorIsThatOfManySamples) {
  const Scene scene = overhead(square_light(1));
  const Plane many = uniform(scene, kMany);
  Sequence sequence(scene);
  sequence.play(30);
  EXPECT_LT(rmse(sequence.visibility, many), 0.006);
}

// The filter stands in for tests that are too few: it must be better than they are, and leave plain surfaces
// alone.
TEST_F(AreaTemporal, NeighboursHelpWhereTestsAreFew) {
  const Scene scene = overhead(square_light(2));
  const Plane many = uniform(scene, kMany);
  Sequence filtered(scene), bare(scene, {{"neighbours", int64_t{1}}});
  for (const int frames : {1, 3}) {
    filtered.play(frames), bare.play(frames);
    EXPECT_LT(rmse(filtered.visibility, many), 0.9 * rmse(bare.visibility, many)) << frames;
  }
  size_t lit = 0;
  for (size_t i = 0; i < many.size(); ++i) lit += many[i] == 1.0f && filtered.visibility[i] == 1.0f;
  EXPECT_GT(double(lit), 0.95 * double(count(many, 1.0f)));
}

// ------------------------------------------------------------------------------------------- movement

// By the ray tracer: did the frame before show what a pixel shows?
enum class Before { shown, hidden, unclear };

std::vector<Before> shown_before(const Scene& scene, double now, double before) {
  const Scene posed_now = posed(scene, now), posed_before = posed(scene, before);
  const RenderSettings s = settings(true);
  const Reference a = hard_shadow::trace(posed_now, s), b = hard_shadow::trace(posed_before, s);
  const Camera& camera = posed_before.cameras[0];
  const glm::dmat4 camera_from_world = glm::inverse(camera.world_from_camera);
  const glm::dvec3 eye(posed_now.cameras[0].world_from_camera[3]);
  const double scale = 0.5 * s.height / std::tan(0.5 * camera.fov_y);  // pixels
  std::vector<Before> result(a.depth.size(), Before::unclear);
  for (size_t i = 0; i < result.size(); ++i) {
    if (a.domain[0][i] != Reference::counted) continue;
    const glm::dvec3 p(camera_from_world * glm::dvec4(glm::dvec3(a.position[i]) + eye, 1));
    const double x = 0.5 * s.width + scale * p.x / -p.z, y = 0.5 * s.height - scale * p.y / -p.z;
    if (x < -0.5 || y < -0.5 || x > s.width + 0.5 || y > s.height + 0.5) {
      result[i] = Before::hidden;
      continue;
    }
    if (x < 1.5 || y < 1.5 || x > s.width - 1.5 || y > s.height - 1.5) continue;
    size_t same = 0;  // of the nine pixels there
    for (int dy : {-1, 0, 1})
      for (int dx : {-1, 0, 1}) {
        const size_t at = size_t(int(y) + dy) * s.width + size_t(int(x) + dx);
        same += b.domain[0][at] == Reference::counted && std::abs(b.depth[at] / -p.z - 1) < 0.02;
      }
    if (same == 9) result[i] = Before::shown;
    if (same == 0) result[i] = Before::hidden;
  }
  return result;
}

TEST_F(AreaTemporal, HistoryFollowsTheCameraAndDisoccludedPixelsBeginAnew) {
  const Scene scene =
      Mover(overhead(square_light(1))).camera(analytic::jump({1.0, -0.5, -0.8}, kFrame)).scene;
  Sequence sequence(scene);
  sequence.play(2);
  const std::vector<Before> before = shown_before(scene, kFrame, 0);
  size_t shown = 0, hidden = 0, wrong = 0;
  for (size_t i = 0; i < before.size(); ++i) {
    if (before[i] == Before::unclear || sequence.tests[i] == 0.0f) continue;
    const bool follows = before[i] == Before::shown;
    (follows ? shown : hidden) += 1;
    wrong += std::abs(sequence.tests[i] - (follows ? 2.0f : 1.0f)) > 1e-4f;
  }
  EXPECT_GT(shown, 5000u);
  EXPECT_GT(hidden, 300u);
  EXPECT_EQ(wrong, 0u);
}

// Less than a pixel a frame: history that stayed with the pixels would be dragged along.
TEST_F(AreaTemporal, ShadowsStayOnTheirReceiversWhileTheCameraCreeps) {
  constexpr int kFrames = 33;
  const Scene scene = Mover(overhead(square_light(1))).camera(glm::dvec3(0.5, 0, -0.5)).scene;
  Sequence sequence(scene);
  sequence.play(kFrames);
  const Plane now = uniform(posed(scene, sequence.seconds()), kMany), then = uniform(posed(scene, 0), kMany);
  ASSERT_GT(rmse(now, then), 0.1);  // the view has changed
  EXPECT_LT(rmse(sequence.visibility, now), 0.02);
}

TEST_F(AreaTemporal, NoShadowIsDraggedBehindAMovingCaster) {
  constexpr int kStill = 20, kMostDragged = 8;
  const Scene scene =
      Mover(overhead(square_light(1))).instance(1, analytic::jump({2.6, 0, 2.6}, kStill * kFrame)).scene;
  Sequence sequence(scene);
  sequence.play(kStill);
  const Plane before = sequence.visibility;
  EXPECT_EQ(*std::max_element(sequence.tests.begin(), sequence.tests.end()), float(kStill))
      << "casters that may move and do not are like others";
  const Plane wanted = uniform(posed(scene, kStill * kFrame), kMany);
  sequence.play(kMostDragged);
  size_t left = 0, reached = 0, wrong_left = 0, wrong_reached = 0;
  for (size_t i = 0; i < wanted.size(); ++i) {
    if (before[i] < 0.5f && wanted[i] == 1.0f) ++left, wrong_left += sequence.visibility[i] < 1.0f;
    if (before[i] == 1.0f && wanted[i] == 0.0f) ++reached, wrong_reached += sequence.visibility[i] > 0.3f;
  }
  EXPECT_GT(left, 100u);
  EXPECT_GT(reached, 100u);
  EXPECT_EQ(wrong_left, 0u);
  EXPECT_LT(double(wrong_reached), 0.02 * double(reached));
}

// The same for a caster that goes on moving, so that its tags are renewed every frame.
TEST_F(AreaTemporal, NoShadowIsDraggedBehindACasterThatGoesOn) {
  constexpr int kMostDragged = 8, kFrames = 28;
  const Scene scene = Mover(overhead(square_light(1))).instance(1, glm::dvec3(5, 0, 5)).scene;
  Sequence sequence(scene);
  sequence.play(kFrames);
  const double now = sequence.seconds();
  const Plane wanted = uniform(posed(scene, now), kMany),
              then = uniform(posed(scene, now - kMostDragged * kFrame), kMany);
  size_t left = 0, wrong = 0;
  std::vector<bool> shadowed_since(wanted.size());
  for (int back = 0; back < kMostDragged; ++back) {
    const Plane v = uniform(posed(scene, now - back * kFrame), 64);
    for (size_t i = 0; i < v.size(); ++i) shadowed_since[i] = shadowed_since[i] || v[i] < 1.0f;
  }
  for (size_t i = 0; i < wanted.size(); ++i) {
    if (then[i] > 0.9f || shadowed_since[i]) continue;
    ++left;
    wrong += sequence.visibility[i] < 1.0f;
  }
  EXPECT_GT(left, 30u);
  EXPECT_EQ(wrong, 0u);
}

TEST_F(AreaTemporal, OlderSamplesWeighLessWhileTheLightMoves) {
  constexpr float kAge = 0.5f;
  const Scene scene = Mover(overhead(square_light(1))).light(glm::dvec3(1, 0, 0)).scene;
  Sequence sequence(scene, {{"age", double(kAge)}});
  float wanted = 0;
  for (int frame = 0; frame < 6; ++frame) {
    sequence.play(1);
    wanted = kAge * wanted + 1;
    EXPECT_EQ(*std::max_element(sequence.tests.begin(), sequence.tests.end()), wanted) << frame;
  }
  sequence.play(40);  // arrived after 32 frames
  EXPECT_GT(*std::max_element(sequence.tests.begin(), sequence.tests.end()), 12.0f);
  EXPECT_LT(rmse(sequence.visibility, uniform(posed(scene, 1), kMany)), 0.02);
}

TEST_F(AreaTemporal, TestsAreForgottenBeyondTheMost) {
  Sequence sequence(overhead(square_light(1)), {{"most_tests", int64_t{16}}});
  sequence.play(20);
  for (const float tests : sequence.tests) ASSERT_LE(tests, 16.0f);
}

// ------------------------------------------------------------------------------------------- lights

TEST_F(AreaTemporal, ALightWithoutAreaIsShadowMapping) {
  Scene scene = overhead({});
  scene.lights.push_back(analytic::light(LightType::directional, {-3, 5, 2}));
  scene.lights.push_back(analytic::light(LightType::point, {-4, 4, -3}));
  const RenderSettings s = settings(true);
  EXPECT_EQ(hard_shadow::visibility("area_temporal", scene, s),
            hard_shadow::visibility("area_uniform", scene, s, {{"samples", int64_t{1}}}));
}

TEST_F(AreaTemporal, ALightOfSizeZeroStaysHard) {
  const Scene scene = overhead(square_light(0));
  const Plane hard = hard_shadow::visibility("area_temporal", overhead({}), settings(true), small_map({}))[0];
  Sequence sequence(scene);
  for (int frame = 0; frame < 3; ++frame) {
    sequence.play(1);
    EXPECT_EQ(sequence.visibility, hard) << frame;
  }
}

TEST_F(AreaTemporal, LightsKeepHistoriesOfTheirOwn) {
  Scene scene = overhead(square_light(1));
  Light second = analytic::light(LightType::spot, {3, 6, 2});
  second.area = square_light(1.5);
  scene.lights.push_back(second);
  scene.lights.push_back(analytic::light(LightType::directional, {1, 3, 0}));
  const RenderSettings s = settings(true);
  Renderer renderer(device(), std::make_shared<Scene>(scene),
                    load_graph(find_graph("area_temporal"), small_map({})), s);
  for (int frame = 0; frame < 64; ++frame) renderer.render(TimingMode::none);
  const Image image = renderer.read("visibility");
  const auto wanted = hard_shadow::visibility("area_uniform", scene, s,
                                              small_map({{"samples", kMany}, {"pattern", "sobol"}}));
  for (size_t light = 0; light < wanted.size(); ++light) {
    const auto got = image.plane(light);
    EXPECT_LT(rmse(Plane(got.begin(), got.end()), wanted[light]), 0.012) << light;
  }
}

TEST_F(AreaTemporal, ATexturedLightIsWeighedByItsEmission) {
  AreaLight area = square_light(1.5);
  area.emission = 0;
  Scene scene = overhead(area);
  Texture grey;  // four columns of unequal brightness, the first of them black
  grey.width = 4, grey.height = 1, grey.nearest = true;
  grey.rgba = {0, 0, 0, 255, 120, 120, 120, 255, 255, 255, 255, 255, 60, 60, 60, 255};
  scene.textures.push_back(grey);
  Sequence sequence(scene);
  sequence.play(64);
  EXPECT_LT(rmse(sequence.visibility, uniform(scene, kMany)), 0.01);
}

// ------------------------------------------------------------------------------------------- formulas

// lib/temporal_shadow.glsl for tests and shadowed tests: standard error, weight, share after fading, tests
// after fading.
TEST_F(AreaTemporal, FormulasAreThoseOfThePaper) {
  const test::Kernel kernel("temporal formulas", R"(
#include "lib/temporal_shadow.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer In { vec2 given[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Out { vec4 results[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= given.length()) return;
  ShadowHistory h = ShadowHistory(given[i].x, given[i].y, 3.0, 5.0, true);
  ShadowHistory faded = fade(h, 8.0, 2.0);
  float kept = unpack_history(pack_history(h)).moving ? 1.0 : 0.0;
  results[i] = vec4(standard_error(hidden_share(h), h.tests), kept * tests_weight(h, 0.02, 0.2, 4.0), hidden_share(faded),
                    faded.tests);
})",
                            2);
  const std::vector<glm::vec2> given = {{1, 1}, {1, 2},    {2, 3},   {3, 4},   {4, 5},
                                        {5, 7}, {50, 100}, {0, 100}, {1, 2.5f}};
  const auto results = kernel.run<glm::vec4>({test::bytes_of(given)}, given.size());
  for (size_t i = 0; i < given.size(); ++i) {
    const double n = given[i].y, share = given[i].x / n;
    const double error = n > 1 ? std::sqrt(share * (1 - share) / (n - 1)) : 1.0;             // (5.3)
    const double weight = n < 4 ? 0.0 : std::clamp((0.2 - error) / (0.2 - 0.02), 0.0, 1.0);  // (5.13)
    const double left = std::max(std::min(n, 8.0) - 2.0, 0.0);                               // (5.16)
    EXPECT_NEAR(results[i].x, error, 1e-6) << i;
    EXPECT_NEAR(results[i].y, weight, 1e-5) << i;
    EXPECT_NEAR(results[i].z, left > 0 ? share : 0.0, 1e-6) << i;
    EXPECT_NEAR(results[i].w, left, 1e-6) << i;
  }
  EXPECT_NEAR(results[5].x, 0.18, 0.005);  // table 5.1
}

TEST_F(AreaTemporal, BlockerDistancesAreAveragedOverTheFrames) {
  const test::Kernel kernel("blocker distances", R"(
#include "lib/temporal_shadow.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer In { vec4 given[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Out { vec2 results[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= given.length()) return;
  ShadowHistory h = ShadowHistory(0.0, given[i].x, 3.0, given[i].y, false);
  float mean = add_blocker(h, given[i].z, 16.0);
  results[i] = vec2(mean, penumbra_width(given[i].w, mean, 0.5));
})",
                            2);
  // tests before, mean blocker, new blocker, receiver
  const std::vector<glm::vec4> given = {{4, 2, 3, 6}, {0, 0, 3, 6}, {100, 2, 2, 6}, {4, 5, 5, 4}};
  const auto results = kernel.run<glm::vec2>({test::bytes_of(given)}, given.size());
  for (size_t i = 0; i < given.size(); ++i) {
    const glm::vec4 g = given[i];
    const double mean = g.y > 0 ? (g.z + g.y * (g.x + 16.0)) / (g.x + 17.0) : double(g.z);  // (5.7)-(5.8)
    EXPECT_NEAR(results[i].x, mean, 1e-5) << i;
    EXPECT_NEAR(results[i].y, std::max(g.w - mean, 0.0) / mean * 0.5, 1e-5) << i;  // (5.6)
  }
}

}  // namespace
}  // namespace gnomon
