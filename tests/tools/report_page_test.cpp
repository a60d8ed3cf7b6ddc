// The report as a reader meets it: `gnomon report` on rows made here, opened in headless Chromium.
#include "tools/report_page.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/base/error.h"
#include "engine/image/image.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

int exit_status(const std::string& command) {
  const int code = std::system(command.c_str());
  return WIFEXITED(code) ? WEXITSTATUS(code) : -1;
}

std::string read_text(const fs::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

class ReportPage : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("report_page_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "run" / "images");
  }
  void TearDown() override { fs::remove_all(folder_); }

  // 8 x 2 pixels, the left `lit` columns 1.
  std::string image(const std::string& name, uint32_t lit) const {
    Image image(8, 2, {"Y"});
    for (uint32_t y = 0; y < 2; ++y)
      for (uint32_t x = 0; x < lit; ++x) image.at(x, y) = 1;
    write_png_gray(folder_ / "run" / "images" / name, image);
    return "images/" + name;
  }
  json row(const std::string& graph, double ms, double rmse, double misclassified, uint32_t lit) const {
    const double ratio = ms / 10;
    return {
        {"key", graph},
        {"scene", "square"},
        {"graph", graph},
        {"vars", {{"shadow_map", 512}}},
        {"set", json::object()},
        {"size", {8, 2}},
        {"camera", 0},
        {"device", "none"},
        {"driver", "none"},
        {"reference", {{"samples", 0}}},
        {"frame_ms", {{"median", ms}, {"mad", 0}, {"ci95", {ms * 0.9, ms * 1.1}}, {"n", 7}}},
        {"ratio", {{"median", ratio}, {"mad", 0}, {"ci95", {ratio, ratio}}, {"n", 7}, {"baseline", "quick"}}},
        {"error", {{"rmse", rmse}, {"misclassified", misclassified}}},
        {"passes",
         {{{"id", "a"},
           {"type", "gbuffer"},
           {"iteration", 0},
           {"gpu_ms", {{"overlapped", {{"median", 2.0}}}}}}}},
        {"left_out", {{{"pass", "blur"}, {"reason", "<b>narrower than a pixel</b></script>"}}}},
        {"warnings", {"open mesh"}},
        {"images",
         {{"visibility", image(graph + ".png", lit)},
          {"reference", image("reference.png", 0)},
          {"domain", image("domain.png", 8)}}},
        {"status", "ok"}};
  }
  void write_rows() const {
    std::ofstream file(folder_ / "run" / "results.jsonl");
    json failed = row("broken", 1, 1, 1, 0);
    failed["status"] = "error: no memory";
    json wider = row("quick", 20, 0.1, 0.05, 2);
    wider["key"] = "quick 1024";
    wider["vars"] = wider["set"] = {{"shadow_map", 1024}};
    for (const json& one : {row("quick", 10, 0.2, 0.1, 4), row("exact", 50, 0.01, 0, 0),
                            row("bad", 60, 0.3, 0.2, 8), wider, failed})
      file << one.dump() << '\n';
  }
  int report(const std::string& arguments) const {
    return exit_status("'" GNOMON_EXECUTABLE "' report '" + (folder_ / "run").string() + "' " + arguments +
                       " >'" + (folder_ / "log").string() + "' 2>&1");
  }
  std::string log() const { return read_text(folder_ / "log"); }
  fs::path folder_;
};

TEST(Base64, PadsAsTheRfcSays) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

TEST_F(ReportPage, WorksInABrowser) {
  write_rows();
  ASSERT_EQ(report(""), 0) << log();
  const std::string driver = GNOMON_TEST_SOURCE_DIR "/tests/tools/report_page_driver.py";
  ASSERT_EQ(exit_status("/usr/bin/python3 '" + driver + "' '" + (folder_ / "run" / "report.html").string() +
                        "' >'" + (folder_ / "log").string() + "' 2>&1"),
            0)
      << log() << "(tools/install-dependencies --test installs Chromium, its driver and Selenium)";
}

TEST_F(ReportPage, IsOneFileWithDataBesideIt) {
  write_rows();
  ASSERT_EQ(report("--image-budget 0 --out '" + (folder_ / "out").string() + "'"), 0) << log();
  const std::string page = read_text(folder_ / "out" / "report.html");
  EXPECT_EQ(page.find("data:image/png"), std::string::npos);
  EXPECT_EQ(page.find("src=\"http"), std::string::npos);
  EXPECT_EQ(page.find("narrower than a pixel</b></script>"), std::string::npos);
  EXPECT_EQ(json::parse(read_text(folder_ / "out" / "report.json"))["rows"].size(), 4u);
  EXPECT_NE(read_text(folder_ / "out" / "report.csv").find("square,8,2,1,none,exact,exact,false,50"),
            std::string::npos);
}

TEST_F(ReportPage, SaysWhatIsMissingAndWritesNothing) {
  EXPECT_EQ(report(""), 2);
  EXPECT_NE(log().find("cannot open the results"), std::string::npos) << log();
  write_rows();
  EXPECT_EQ(exit_status("GNOMON_CHARTS=/nowhere/chart.js '" GNOMON_EXECUTABLE "' report '" +
                        (folder_ / "run").string() + "' >'" + (folder_ / "log").string() + "' 2>&1"),
            2);
  EXPECT_NE(log().find("libjs-chart.js"), std::string::npos) << log();
  EXPECT_FALSE(fs::exists(folder_ / "run" / "report.html"));
}

}  // namespace
}  // namespace gnomon
