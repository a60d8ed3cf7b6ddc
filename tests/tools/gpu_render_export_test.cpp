// `gnomon render --export`: what of a frame is there for programs that learn from it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/image/image.h"
#include "tests/faults/program.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::vector<std::string> command(const std::string& scene, const std::string& graph) {
  return {"render", scene,      "--graph", graph,      "--size", "96x64",    "--repeat",
          "1",      "--warmup", "0",       "--export", "frame",  "--device", "llvmpipe"};
}

TEST(RenderExport, HasEverythingThatItsJsonNames) {
  const test::Program program("export");
  const test::Ended ended = program.run(command("sun_and_lamp", "shadow_mapping"));
  ASSERT_EQ(ended.status, 0) << ended.error;
  const json frame = json::parse(program.read("frame/frame.json"));
  size_t files = 1;
  for (const auto& [name, said] : frame["files"].items()) {
    const Image image = read_exr(program.folder() / "frame" / name);
    EXPECT_EQ(image.channels.size(), said["channels"].size()) << name;
    for (const json& channel : said["channels"]) EXPECT_TRUE(image.has(channel)) << name;
    ++files;
  }
  EXPECT_EQ(files, size_t(std::distance(fs::directory_iterator(program.folder() / "frame"), {})));
  for (const char* name : {"depth", "normal", "albedo", "position", "visibility", "reference"})
    EXPECT_TRUE(frame["files"].contains(name + std::string(".exr"))) << name;
  EXPECT_EQ(read_exr(program.folder() / "frame/visibility.exr").channels.size(), frame["lights"].size());
}

// A pixel's position, seen by a light: its depth in the map, or less where something hides it.
TEST(RenderExport, PositionsFindTheirDepthInTheMap) {
  const test::Program program("export_map");
  const test::Ended ended = program.run(command("square_plane", "shadow_mapping"));
  ASSERT_EQ(ended.status, 0) << ended.error;
  const json frame = json::parse(program.read("frame/frame.json"));
  const json& map = frame["shadow_maps"].at(0);
  const json& view = map["views"].at(0);
  EXPECT_EQ(map["encoding"], "perspective");
  const fs::path folder = program.folder() / "frame";
  const Image position = read_exr(folder / "position.exr"), truth = read_exr(folder / "reference.exr"),
              depths = read_exr(folder / map["file"].get<std::string>());
  const auto product = [](const json& m, const std::array<double, 4>& p) {
    std::array<double, 4> result{};
    for (size_t r = 0; r < 4; ++r)
      for (size_t c = 0; c < 4; ++c) result[r] += m[r][c].get<double>() * p[c];
    return result;
  };
  int lit = 0, wrong = 0;
  for (uint32_t i = 0; i < 96 * 64; ++i) {
    if (truth.plane("Y")[i] != 1 || position.plane("X")[i] == 0) continue;
    std::array<double, 4> p{0, 0, 0, 1};
    for (size_t c = 0; c < 3; ++c)
      p[c] = position.plane(std::string(1, char('X' + c)))[i] +
             frame["camera"]["world_from_camera"][c][3].get<double>();
    const auto clip = product(view["clip_from_light"], product(view["light_from_world"], p));
    const double x = 0.5 + 0.5 * clip[0] / clip[3], y = 0.5 + 0.5 * clip[1] / clip[3];
    if (!(x > 0 && x < 1 && y > 0 && y < 1)) continue;
    const float depth = depths.at(uint32_t(x * depths.width), uint32_t(y * depths.height));
    ++lit, wrong += std::abs(depth - clip[2] / clip[3]) > 1e-3;
  }
  EXPECT_GT(lit, 1000);
  EXPECT_LT(wrong, lit / 50);
}

TEST(RenderExport, OverwritesNothing) {
  const test::Program program("export_again");
  fs::create_directory(program.folder() / "frame");
  program.write("frame/mine.txt", "kept");
  const auto before = program.content();
  const test::Ended ended = program.run(command("square_plane", "shadow_mapping"));
  EXPECT_EQ(ended.status, 2);
  EXPECT_NE(ended.error.find("not empty"), std::string::npos) << ended.error;
  EXPECT_EQ(program.content(), before);
}

}  // namespace
}  // namespace gnomon
