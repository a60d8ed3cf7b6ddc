// What comes from elsewhere: pipes in place of files, rows that name other files, names that are paths.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/report/report_image_files.h"
#include "engine/base/error.h"
#include "engine/image/image.h"
#include "tests/faults/program.h"
#include "tools/output_folder.h"

namespace gnomon::test {
namespace {

namespace fs = std::filesystem;

TEST(Untrusted, APipeInPlaceOfAnyInputIsRefusedAndNotWaitedFor) {
  const Program program("pipes");
  for (const char* name : {"pipe", "pipe.json", "pipe.glb", "pipe.exr", "pipe.png", "results.jsonl"})
    ASSERT_EQ(mkfifo((program.folder() / name).c_str(), 0600), 0);
  const std::vector<std::vector<std::string>> commands = {{"check", "pipe.json"},
                                                          {"check", "pipe.glb"},
                                                          {"report", "."},
                                                          {"bench", "pipe.json", "--out", "out"},
                                                          {"explain", "fence", "--graph", "pipe.json"},
                                                          {"explain", "pipe.glb", "--graph", "pcf"},
                                                          {"reference", "pipe.glb", "--out", "x.exr"},
                                                          {"compare", "pipe.exr", "pipe.exr"},
                                                          {"edt", "pipe.png", "x.exr"}};
  for (const auto& command : commands) {
    const Ended ended = program.run(command);
    EXPECT_EQ(ended.status, 2) << command[0] << ": " << ended.error;
    EXPECT_NE(ended.error.find("pipe"), std::string::npos) << command[0] << ": " << ended.error;
  }
  EXPECT_FALSE(fs::exists(program.folder() / "x.exr"));
}

TEST(Untrusted, OnlyImagesBelowTheRunsFolderAreShown) {
  const Program program("images");
  write_png_gray(program.folder() / "beside.png", Image(2, 2, {"Y"}));
  fs::create_directories(program.folder() / "run" / "images");
  write_png_gray(program.folder() / "run" / "images" / "own.png", Image(2, 2, {"Y"}));
  const fs::path run = program.folder() / "run";
  fs::create_symlink("../../beside.png", run / "images" / "link.png");
  EXPECT_TRUE(image_below(run, "images/own.png"));
  EXPECT_TRUE(image_below(run, "images/../images/own.png"));
  for (const char* name : {"/etc/passwd", "../beside.png", "images/link.png", "images", "absent.png", ""})
    EXPECT_FALSE(image_below(run, name)) << name;
}

TEST(Untrusted, AReportCarriesNoFileThatIsNoImageOfItsRun) {
  const Program program("report");
  nlohmann::json row = {{"key", "a"},
                        {"scene", "s"},
                        {"graph", "g"},
                        {"size", {2, 2}},
                        {"status", "ok"},
                        {"frame_ms", {{"median", 1}}},
                        {"error", {{"rmse", 0.1}}}};
  program.write("secret", "a secret that no report shows");
  program.write("run/text.png", "a secret that no report shows");
  row["images"] = {{"visibility", "../secret"}, {"reference", "/etc/passwd"}, {"color", "text.png"}};
  program.write("run/results.jsonl", row.dump() + "\n");
  const Ended ended = program.run({"report", "run"});
  ASSERT_EQ(ended.status, 0) << ended.error;
  EXPECT_NE(ended.error.find("3 images"), std::string::npos) << ended.error;
  EXPECT_EQ(program.read("run/report.html").find("data:image/png;base64"), std::string::npos);
}

TEST(Untrusted, DeepRowsAreRefused) {
  const Program program("deep");
  constexpr size_t deep = 100000;
  program.write("run/results.jsonl", "{\"key\": " + std::string(deep, '[') + std::string(deep, ']') + "}\n");
  const Ended ended = program.run({"report", "run"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_NE(ended.error.find("nested deeper than 64 levels"), std::string::npos) << ended.error;
}

TEST(Untrusted, NamesFromFilesAreNoPaths) {
  EXPECT_EQ(as_file_name("fence-pcf_2.5"), "fence-pcf_2.5");
  EXPECT_EQ(as_file_name("x/../../../escaped"), "x_.._.._.._escaped");
  EXPECT_EQ(as_file_name(""), "_");
  EXPECT_EQ(as_file_name(".."), "_..");
  EXPECT_EQ(as_file_name("a\nb\x1b[31m"), "a_b__31m");
  EXPECT_LE(as_file_name(std::string(5000, 'a')).size(), 101u);
}

TEST(Untrusted, WithoutAPlaceForCachesAllIsWell) {
  const Program program("nowhere");
  const Ended ended = program.run({"reference", "square_plane", "--size", "16x9", "--out", "x.exr"},
                                  {"GNOMON_CACHE=", "XDG_CACHE_HOME=", "HOME=", "TMPDIR=/nowhere"});
  EXPECT_EQ(ended.status, 0) << ended.error;
}

}  // namespace
}  // namespace gnomon::test
