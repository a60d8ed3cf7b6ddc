// Where numbers have a decimal comma, files are what they are elsewhere.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/faults/program.h"

namespace gnomon::test {
namespace {

// A locale of the test's own: German, which a machine need not have.
class DecimalComma : public testing::Test {
 protected:
  void SetUp() override {
    const std::string place = (program_.folder() / "locales").string();
    const std::string make = "mkdir -p " + place + " && localedef --no-archive -i de_DE -f UTF-8 " + place +
                             "/de_DE.UTF-8 2>/dev/null";
    ASSERT_EQ(std::system(make.c_str()), 0) << "localedef and Debian's package locales are needed";
    environment_ = {"LOCPATH=" + place, "LC_ALL=de_DE.UTF-8", "LANG=de_DE.UTF-8"};
  }
  void same(const std::vector<std::string>& arguments, const std::vector<std::string>& files) const {
    const Ended plain = program_.run(arguments, {"LC_ALL=C"});
    ASSERT_EQ(plain.status, 0) << plain.error;
    std::vector<std::string> before;
    for (const std::string& file : files) before.push_back(program_.read(file));
    const Ended german = program_.run(arguments, environment_);
    ASSERT_EQ(german.status, 0) << german.error;
    for (size_t i = 0; i < files.size(); ++i) EXPECT_EQ(program_.read(files[i]), before[i]) << files[i];
  }
  Program program_{testing::UnitTest::GetInstance()->current_test_info()->name()};
  std::vector<std::string> environment_;
};

TEST_F(DecimalComma, ImagesScenesAndReportsAreTheSameBytes) {
  same({"render", "fence", "--graph", "pcf", "--set", "shadow_map=256", "--size", "32x18", "--repeat", "1",
        "--light-scale", "0.5", "--device", "llvmpipe", "--out", "out"},
       {"out/visibility.exr", "out/color.exr", "out/color.png"});
  same({"reference", "square_plane", "--size", "32x18", "--samples", "4", "--out", "truth.exr"},
       {"truth.exr"});
  same({"scene", "generate", "sphere_plane", "--out", "."}, {"sphere_plane.glb"});
  program_.write("run/results.jsonl",
                 R"({"key": "a", "scene": "s", "graph": "g", "size": [2, 2], "status": "ok",)"
                 R"( "frame_ms": {"median": 1.5}, "error": {"rmse": 0.25}})"
                 "\n");
  same({"report", "run", "--out", "page"}, {"page/report.csv", "page/report.json", "page/report.html"});
}

TEST_F(DecimalComma, RowsHaveDecimalPoints) {
  const Ended ended = program_.run({"render", "square_plane", "--graph", "shadow_mapping", "--size", "32x18",
                                    "--repeat", "3", "--error", "--device", "llvmpipe", "--out", "out"},
                                   environment_);
  ASSERT_EQ(ended.status, 0) << ended.error;
  const nlohmann::json row = nlohmann::json::parse(program_.read("out/run.json"));
  const double ms = row["frame_ms"]["median"];
  EXPECT_NE(ms, std::floor(ms));
}

}  // namespace
}  // namespace gnomon::test
