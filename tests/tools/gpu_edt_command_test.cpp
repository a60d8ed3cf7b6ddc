// `gnomon edt` as its user meets it.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/image/image.h"
#include "tests/passes/distance/gpu_distance_oracle.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

class EdtCommand : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("edt_test_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  int run(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.string() + "' && '" GNOMON_EXECUTABLE "' edt " + arguments +
                                " --device llvmpipe >out.txt 2>error.txt";
    const int code = std::system(command.c_str());
    return WIFEXITED(code) ? WEXITSTATUS(code) : -1;
  }
  nlohmann::json read_json(const std::string& name) const {
    std::ifstream stream(folder_ / name);
    return nlohmann::json::parse(stream);
  }

  fs::path folder_;
};

TEST_F(EdtCommand, WritesDistancesAndFigures) {
  const Image mask = distance_oracle::random_mask(75, 50, 0.01, 4);
  write_exr(folder_ / "mask.exr", mask);
  write_png_gray(folder_ / "mask.png", mask);
  const auto exact = distance_oracle::squared_distances(mask);
  for (const char* name : {"mask.exr", "mask.png"}) {
    ASSERT_EQ(run(std::string(name) + " out.exr --algorithm banded_exact --repeat 3 --json out.json"), 0);
    const Image distance = read_exr(folder_ / "out.exr");
    ASSERT_EQ(distance.channels, std::vector<std::string>{"Y"});
    for (size_t i = 0; i < exact.size(); ++i)
      ASSERT_EQ(distance.data[i], float(std::sqrt(double(exact[i])))) << i;
  }
  const nlohmann::json row = read_json("out.json");
  EXPECT_EQ(row["gpu_ms"]["n"], 3);
  double steps_ms = 0;
  for (const auto& [step, times] : row["steps"].items()) steps_ms += times["gpu_ms"]["median"].get<double>();
  EXPECT_GT(steps_ms, 0);
  EXPECT_EQ(row["size"], (nlohmann::json{75, 50}));
  EXPECT_EQ(row["sites"], std::count(mask.data.begin(), mask.data.end(), 1.0f));
}

TEST_F(EdtCommand, NoSiteIsInfinitelyFar) {
  write_exr(folder_ / "mask.exr", Image(9, 7, {"R", "G", "A"}));
  ASSERT_EQ(run("mask.exr out.exr"), 0);
  for (const float v : read_exr(folder_ / "out.exr").data) EXPECT_TRUE(std::isinf(v) && v > 0);
}

TEST_F(EdtCommand, TellsTheErrorOfApproximations) {
  write_exr(folder_ / "mask.exr", distance_oracle::random_mask(256, 256, 0.01, 4));
  ASSERT_EQ(run("mask.exr out.exr --algorithm jump_flooding --variant jfa --repeat 1 --json out.json"), 0);
  const nlohmann::json row = read_json("out.json");
  EXPECT_GT(row["wrong_pixels"], 0);
  EXPECT_GT(row["largest_error"], 0.0);
  EXPECT_LT(row["largest_error"], 4.0);
}

TEST_F(EdtCommand, BadInputIsStatusTwoAndLeavesNothing) {
  Image mask(8, 8, {"Y"});
  write_exr(folder_ / "mask.exr", mask);
  mask.at(3, 3) = NAN;
  write_exr(folder_ / "nan.exr", mask);
  write_exr(folder_ / "wide.exr", Image(16385, 1, {"Y"}));
  std::ofstream(folder_ / "text.png") << "no image";
  for (const char* arguments :
       {"absent.png out.exr", "text.png out.exr", "nan.exr out.exr", "mask.exr out.png", "wide.exr out.exr",
        "mask.exr out.exr --algorithm magic", "mask.exr out.exr --variant magic",
        "mask.exr out.exr --radius 0", "mask.exr out.exr --repeat 0", "mask.exr absent/folder/out.exr"}) {
    EXPECT_EQ(run(arguments), 2) << arguments;
    EXPECT_FALSE(fs::exists(folder_ / "out.exr")) << arguments;
    EXPECT_FALSE(fs::exists(folder_ / "out.json")) << arguments;
    EXPECT_GT(fs::file_size(folder_ / "error.txt"), 0u) << arguments;
  }
}

}  // namespace
}  // namespace gnomon
