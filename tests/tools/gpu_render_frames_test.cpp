// `gnomon render --frames` and suites with "frames" as their user meets them.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/image/image.h"
#include "tools/report_page.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class RenderFrames : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("frames_test_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  int run(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.string() +
                                "' && GNOMON_CACHE=cache '" GNOMON_EXECUTABLE "' " + arguments +
                                " --device llvmpipe >out.txt 2>error.txt";
    const int code = std::system(command.c_str());
    return WIFEXITED(code) ? WEXITSTATUS(code) : -1;
  }
  std::string text(const std::string& name) const {
    std::ifstream stream(folder_ / name);
    std::stringstream all;
    all << stream.rdbuf();
    return all.str();
  }

  fs::path folder_;
};

TEST_F(RenderFrames, EachFrameHasItsImageErrorAndFlicker) {
  ASSERT_EQ(
      run("render pendulum --graph shadow_mapping --size 96x64 --frames 3 --fps 4 --warmup 1 --repeat 2 "
          "--reference 0 --write-frames --out out"),
      0)
      << text("error.txt");
  const json row = json::parse(text("out/run.json"));
  ASSERT_EQ(row["frames"].size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    const json& frame = row["frames"][i];
    EXPECT_EQ(frame["time"], 0.25 * double(i));
    EXPECT_GT(frame["frame_ms"], 0);
    EXPECT_GT(frame["error"]["pixels"], 1000);
    EXPECT_LT(frame["error"]["rmse"], 0.3);
    EXPECT_EQ(frame["error"].contains("flicker"), i > 0);
  }
  EXPECT_EQ(row["frame_ms"]["n"], 3);
  EXPECT_EQ(row["passes"][0]["gpu_ms"]["isolated"]["n"], 2);
  EXPECT_EQ(row["sequence"]["frames"], 3);
  EXPECT_NEAR(row["flicker"].get<double>(), row["sequence"]["flicker"]["mean"].get<double>(), 1e-12);
  EXPECT_EQ(row["error"]["rmse"], row["frames"][2]["error"]["rmse"]);  // the last frame's
  EXPECT_TRUE(row["error"].contains("acne"));
  const Image first = read_exr(folder_ / "out/frame_0000_visibility.exr"),
              last = read_exr(folder_ / "out/frame_0002_visibility.exr");
  EXPECT_NE(first.data, last.data);
  EXPECT_EQ(last.data, read_exr(folder_ / "out/visibility.exr").data);
  EXPECT_TRUE(fs::exists(folder_ / "out/frame_0001_color.png"));
}

// The reference command at a frame's time is what the frame is compared with.
TEST_F(RenderFrames, ReferenceAtATimeIsTheFrames) {
  ASSERT_EQ(
      run("render pendulum --camera 1 --graph shadow_mapping --size 64x48 --frames 2 --fps 2 --repeat 1 "
          "--error --write-frames --out out"),
      0)
      << text("error.txt");
  const json row = json::parse(text("out/run.json"));
  for (int i = 0; i < 2; ++i) {
    const std::string command = "cd '" + folder_.string() + "' && '" GNOMON_EXECUTABLE "' ";
    const std::string reference = "reference pendulum --camera 1 --size 64x48 --out truth.exr --time ";
    ASSERT_EQ(std::system((command + reference + (i == 0 ? "0" : "0.5") + " >out.txt 2>&1").c_str()), 0);
    ASSERT_EQ(std::system((command + "compare out/frame_000" + std::to_string(i) +
                           "_visibility.exr truth.exr --json >figures.json")
                              .c_str()),
              0);
    const json error = json::parse(text("figures.json"));
    EXPECT_NEAR(error["rmse"].get<double>(), row["frames"][i]["error"]["rmse"].get<double>(), 1e-9);
  }
}

TEST_F(RenderFrames, StillSceneHasSteadyErrors) {
  ASSERT_EQ(
      run("render square_plane --graph pcf --size 64x48 --frames 2 --warmup 1 --repeat 1 --error --out out"),
      0)
      << text("error.txt");
  const json row = json::parse(text("out/run.json"));
  EXPECT_EQ(row["frames"][1]["error"]["flicker"], 0);
  EXPECT_GT(row["sequence"]["rmse"]["mean"], 0);
  EXPECT_FALSE(fs::exists(folder_ / "out/frame_0000_visibility.exr"));
}

TEST_F(RenderFrames, BadRequestsAreStatusTwo) {
  for (const char* bad :
       {"--fps 0 --frames 2", "--fps -5 --frames 2", "--write-frames", "--frames 0", "--frames x"}) {
    EXPECT_NE(run("render pendulum --graph shadow_mapping --size 16x16 --out out " + std::string(bad)), 0)
        << bad;
    EXPECT_FALSE(fs::exists(folder_ / "out")) << bad;
    EXPECT_FALSE(text("error.txt").empty()) << bad;
  }
}

// A triangle that faces up, seen from above, with its light below.
std::string lit_from_below() {
  const float corners[] = {-5, 0, 5, 5, 0, 5, 0, 0, -5};
  const std::string bytes(reinterpret_cast<const char*>(corners), sizeof corners);
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
"extensionsUsed": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
"cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
"nodes": [{"mesh": 0},
  {"camera": 0, "translation": [0, 5, 8], "rotation": [-0.2588190451, 0, 0, 0.9659258263]},
  {"translation": [0, -3, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
  "min": [-5, 0, -5], "max": [5, 0, 5]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)" +
         base64(bytes) + "\"}]}";
}

TEST_F(RenderFrames, WithoutCountedPixelsTheErrorIsEmptyAndSaysWhy) {
  std::ofstream(folder_ / "below.gltf") << lit_from_below();
  ASSERT_EQ(run("render below.gltf --graph shadow_mapping --size 32x24 --repeat 1 --error --out out"), 0)
      << text("error.txt");
  const json row = json::parse(text("out/run.json"));
  EXPECT_EQ(row["status"], "ok");
  EXPECT_EQ(row["error"]["pixels"], 0);
  EXPECT_TRUE(row["error"]["rmse"].is_null());
  ASSERT_EQ(row["error"]["lights"].size(), 1u);
  EXPECT_NE(row["error"]["lights"][0]["reason"].get<std::string>().find("face away from the light"),
            std::string::npos);
}

TEST_F(RenderFrames, WarningsOfTheCacheAreNotResults) {
  const std::string render =
      "render square_plane --graph shadow_mapping --size 16x9 --repeat 1 --error --out out";
  ASSERT_EQ(run(render), 0) << text("error.txt");
  size_t broken = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "cache"))
    if (entry.path().extension() == ".exr") std::ofstream(entry.path()) << "broken", ++broken;
  ASSERT_EQ(broken, 1u);
  ASSERT_EQ(run(render), 0) << text("error.txt");
  EXPECT_EQ(text("out.txt").find("traced again"), std::string::npos) << text("out.txt");
  const size_t warning = text("error.txt").find("gnomon: warning: ");
  ASSERT_NE(warning, std::string::npos) << text("error.txt");
  EXPECT_NE(text("error.txt").find("traced again", warning), std::string::npos) << text("error.txt");
}

TEST_F(RenderFrames, SuitesHaveSequences) {
  const std::string scene = std::string(GNOMON_TEST_SOURCE_DIR) + "/assets/scenes/moving_light.glb";
  std::ofstream(folder_ / "suite.json") << R"({ "schema": 1, "scenes": [")" << scene
                                        << R"("], "size": [64, 48], "frames": 3, "fps": 2, "warmup": 1,
               "instrumented": 1, "graphs": ["shadow_mapping", "pcf"] })";
  ASSERT_EQ(run("bench suite.json --out out"), 0) << text("error.txt");
  std::istringstream rows(text("out/results.jsonl"));
  std::string line;
  int count = 0;
  for (; std::getline(rows, line); ++count) {
    const json row = json::parse(line);
    EXPECT_EQ(row["status"], "ok");
    ASSERT_EQ(row["frames"].size(), 3u);
    EXPECT_EQ(row["frames"][2]["time"], 1.0);
    EXPECT_EQ(row["error"]["rmse"], row["frames"][2]["error"]["rmse"]);
    EXPECT_GT(row["flicker"], 0);
    EXPECT_EQ(row["ratio"]["n"], 3);
  }
  EXPECT_EQ(count, 2);
}

}  // namespace
}  // namespace gnomon
