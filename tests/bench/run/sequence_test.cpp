// Frames in order: which pixels show the same point, references of each pose, figures of a sequence.
#include "bench/run/sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/run/rounds.h"
#include "bench/run/row.h"
#include "engine/scene/animation.h"
#include "tests/engine/truth/analytic_scenes.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// One light, no geometry anywhere.
Reference empty(uint32_t width, uint32_t height) {
  Reference r;
  const size_t size = size_t{width} * height;
  r.width = width, r.height = height, r.lights = 1;
  r.visibility = {std::vector<float>(size, 1)};
  r.domain = {std::vector<uint8_t>(size, Reference::counted)};
  r.depth.assign(size, INFINITY);
  r.position.assign(size, glm::vec3(0));
  r.normal.assign(size, glm::vec3(0));
  return r;
}

// A wall at z = -10 that faces a camera at (x, 0, 0), all over the image.
Reference wall(const Camera& camera, uint32_t width, uint32_t height) {
  Reference r = empty(width, height);
  const double half_y = 10 * std::tan(0.5 * camera.fov_y), half_x = half_y * width / height;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      const size_t i = size_t{y} * width + x;
      r.depth[i] = 10;
      r.normal[i] = {0, 0, 1};
      r.position[i] = {half_x * (2 * (x + 0.5) / width - 1), half_y * (1 - 2 * (y + 0.5) / height), -10};
    }
  return r;
}

Camera at(double x) {
  Camera camera;
  camera.world_from_camera[3].x = x;
  return camera;
}

TEST(PixelsBefore, AStillCameraKeepsThem) {
  Reference now = wall(at(0), 4, 3), before = wall(at(0), 4, 3);
  now.depth[5] = INFINITY;
  before.depth[7] = INFINITY;
  before.position[2] = {99, 99, -99};  // something else was there
  const auto pixels = pixels_before(now, at(0), before, at(0));
  for (uint32_t i = 0; i < 12; ++i) EXPECT_EQ(pixels[i], i == 5 || i == 7 ? kNotSeenBefore : i) << i;
}

// The camera goes right by two pixels of the wall: what is at x now was at x + 2.
TEST(PixelsBefore, AMovingCameraFindsThePoint) {
  constexpr uint32_t width = 8, height = 6;
  const double pixel = 2 * 10 * std::tan(0.5 * Camera().fov_y) / height;
  const Camera from = at(1000), to = at(1000 + 2 * pixel);
  const Reference now = wall(to, width, height), before = wall(from, width, height);
  const auto pixels = pixels_before(now, to, before, from);
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x)
      EXPECT_EQ(pixels[y * width + x], x + 2 < width ? y * width + x + 2 : kNotSeenBefore) << x << " " << y;
}

TEST(PixelsBefore, AnotherSurfaceIsNoMatch) {
  constexpr uint32_t width = 8, height = 6;
  const Camera from = at(0), to = at(1e-9);
  const Reference now = wall(to, width, height);
  Reference nearer = wall(from, width, height), tilted = nearer;
  for (glm::vec3& p : nearer.position) p *= 0.99f;  // 1 % before the wall
  for (glm::vec3& n : tilted.normal) n = {0.6f, 0, 0.8f};
  EXPECT_EQ(pixels_before(now, to, nearer, from)[20], kNotSeenBefore);
  EXPECT_EQ(pixels_before(now, to, tilted, from)[20], kNotSeenBefore);
  EXPECT_EQ(pixels_before(now, to, empty(width, height), from)[20], kNotSeenBefore);
  EXPECT_EQ(pixels_before(now, to, wall(from, width, height), from)[20], 20u);
}

Image visibility(const std::vector<float>& values) {
  Image image(static_cast<uint32_t>(values.size()), 1, {"Y"});
  image.data = values;
  return image;
}

FrameTruth truth_of(const std::vector<float>& values, double seconds) {
  Reference r = empty(static_cast<uint32_t>(values.size()), 1);
  r.depth.assign(values.size(), 1);
  r.visibility[0] = values;
  FrameTruth truth;
  truth.seconds = seconds;
  truth.reference = std::make_shared<Reference>(r);
  for (uint32_t i = 0; seconds > 0 && i < values.size(); ++i) truth.before.push_back(i);
  return truth;
}

json row_of(const SequenceResult& result) {
  Row row;
  describe_sequence(row, result);
  return to_json(row);
}

// Errors by hand. Frame 0: 0, 0. Frame 1: the shadow moved and the result followed: 0, 0. Frame 2: -1, 0.5.
// Frame 3: the same errors again.
TEST(Sequence, FiguresAreThoseOfItsFrames) {
  SequenceResult result;
  result.add(truth_of({0, 1}, 0), 5, visibility({0, 1}));
  result.add(truth_of({1, 0}, 0.1), 6, visibility({1, 0}));
  result.add(truth_of({1, 0}, 0.2), 7, visibility({0, 0.5f}));
  result.add(truth_of({1, 0}, 0.3), 7, visibility({0, 0.5f}));
  ASSERT_EQ(result.frames().size(), 4u);
  EXPECT_FALSE(result.frames()[0].error->flicker);
  EXPECT_EQ(result.frames()[1].error->flicker, 0.0);
  EXPECT_EQ(result.frames()[2].error->flicker, 0.75);
  EXPECT_EQ(result.frames()[3].error->flicker, 0.0);  // wrong, but steady
  const double rmse = std::sqrt(1.25 / 2);
  EXPECT_NEAR(result.rmse()->mean, rmse / 2, 1e-12);
  EXPECT_NEAR(result.rmse()->max, rmse, 1e-12);
  EXPECT_EQ(result.flicker()->mean, 0.25);
  EXPECT_EQ(result.flicker()->max, 0.75);
  const json row = row_of(result);
  EXPECT_EQ(row["frames"].size(), 4u);
  EXPECT_EQ(row["frames"][1]["time"], 0.1);
  EXPECT_EQ(row["frames"][1]["frame_ms"], 6);
  EXPECT_EQ(row["frames"][2]["error"]["flicker"], 0.75);
  EXPECT_EQ(row["flicker"], 0.25);
  EXPECT_EQ(row["sequence"]["frames"], 4);
  EXPECT_NEAR(row["sequence"]["rmse"]["max"].get<double>(), rmse, 1e-12);
}

TEST(Sequence, AFrameThatIsNotFiniteSpoilsTheFigures) {
  SequenceResult result;
  result.add(truth_of({0, 1}, 0), 5, visibility({0, 1}));
  result.add(truth_of({0, 1}, 0.1), 5, visibility({NAN, 1}));
  result.add(truth_of({0, 1}, 0.2), 5, visibility({0, 1}));
  EXPECT_TRUE(std::isnan(result.rmse()->mean));
  EXPECT_TRUE(std::isnan(result.rmse()->max));
  EXPECT_TRUE(std::isnan(result.flicker()->max));
  EXPECT_TRUE(row_of(result)["flicker"].is_null());
}

TEST(Sequence, WithoutAReferenceThereAreTimes) {
  SequenceResult result;
  result.add(0.0, 3);
  result.add(0.5, 4);
  EXPECT_FALSE(result.rmse());
  EXPECT_FALSE(result.flicker());
  const json row = row_of(result);
  EXPECT_EQ(row["frames"][1], (json{{"time", 0.5}, {"frame_ms", 4.0}}));
  EXPECT_TRUE(row["flicker"].is_null());
}

// Each frame's reference is that of the scene as it stands then; a still scene is traced once.
TEST(SequenceTruth, FollowsTheScene) {
  const fs::path cache = fs::path(testing::TempDir()) / "sequence_test_cache";
  fs::remove_all(cache);
  Scene scene = analytic::square_over_plane(analytic::light(LightType::spot, {1.5, 7, 1}));
  ReferenceSettings settings;
  settings.width = 40, settings.height = 30;
  SequenceTruth still(std::make_shared<const Scene>(scene), settings, cache, 0.5);
  const Reference* first = still.at(0).reference.get();
  EXPECT_TRUE(still.at(0).before.empty());
  EXPECT_EQ(still.at(3).reference.get(), first);
  EXPECT_EQ(still.at(3).before.size(), 1200u);

  const auto animation = std::make_shared<Animation>();
  const Track right{Interpolation::linear, {0, 1}, {glm::dvec4(0, 2, 0, 0), glm::dvec4(3, 2, 0, 0)}};
  animation->nodes.push_back({{}, {}, right, {}, {}, true});
  animation->instances.push_back({1, 0, glm::dmat4(1.0)});
  scene.instances[1].moving = true;
  scene.animation = animation;
  SequenceTruth moving(std::make_shared<const Scene>(scene), settings, cache, 0.5);
  for (uint32_t frame = 0; frame < 3; ++frame) {
    const FrameTruth& truth = moving.at(frame);
    EXPECT_EQ(truth.seconds, 0.5 * frame);
    EXPECT_EQ(truth.scene->instances[1].world_from_object[3].x, 1.5 * frame);
    const Reference traced = ReferenceTracer(posed(scene, 0.5 * frame)).trace(settings);
    EXPECT_EQ(truth.reference->visibility, traced.visibility) << frame;
    EXPECT_EQ(truth.before.size(), frame == 0 ? 0u : 1200u);
  }
  EXPECT_EQ(moving.at(1).seconds, 0.5);  // going back works
  fs::remove_all(cache);
}

class Playing : public Subject {
 public:
  explicit Playing(std::string& log) : log_(log) {}
  FrameTiming render(TimingMode mode) override {
    log_ += mode == TimingMode::none ? "n" : mode == TimingMode::overlapped ? "o" : "i";
    return {};
  }
  void play() override { log_ += "P"; }

 private:
  std::string& log_;
};

TEST(Rounds, SequencesPlayAfterTheWarmUp) {
  std::string log;
  Playing a(log);
  RoundSettings settings{2, 3, 2, true};
  const auto samples = run_rounds({&a}, settings, {},
                                  [&](size_t subject, TimingMode mode, uint32_t frame, const FrameTiming&) {
                                    EXPECT_EQ(subject, 0u);
                                    if (mode == TimingMode::none) log += std::to_string(frame);
                                  });
  EXPECT_EQ(log, "nnPn0n1n2oPooiPii");
  EXPECT_EQ(samples[0].plain.size(), 3u);
  log.clear();
  settings.sequence = false;
  run_rounds({&a}, settings);
  EXPECT_EQ(log, "nnnnnoooiii");
}

}  // namespace
}  // namespace gnomon
