// Folders that cannot be written, that vanish, and that two processes want at once.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "engine/image/image.h"
#include "tests/faults/program.h"

namespace gnomon::test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr const char* suite =
    R"({"schema": 1, "scenes": [")" GNOMON_TEST_SOURCE_DIR
    R"(/assets/scenes/square_plane.glb"], "size": [32, 18], "repeat": 2, "baseline": "shadow_mapping",
        "graphs": ["shadow_mapping", {"name": "pcf", "set": {"kernel": [3, 5, 7, 9]}}]})";

const std::vector<std::string> render = {"render",   "square_plane", "--graph",  "shadow_mapping",
                                         "--size",   "32x18",        "--repeat", "1",
                                         "--device", "llvmpipe",     "--out"};
const std::vector<std::string> bench = {"bench", "suite.json", "--device", "llvmpipe", "--out"};

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// Nobody can make a file there, whatever his rights.
TEST(ReadOnlyFolder, IsNamedAndStatusIsTwo) {
  const Program program("readonly");
  program.write("suite.json", suite);
  program.write("run/results.jsonl",
                R"({"key": "a", "scene": "s", "graph": "g", "size": [2, 2], "frame_ms": {"median": 1}})"
                "\n");
  const auto before = program.content();
  const std::vector<std::vector<std::string>> commands = {
      with(render, {"/proc/gnomon"}),
      with(bench, {"/proc/gnomon"}),
      {"report", "run", "--out", "/proc/gnomon"},
      {"reference", "square_plane", "--size", "16x9", "--out", "/proc/gnomon.exr"},
      {"scene", "generate", "fence", "--out", "/proc/gnomon"},
      with(render, {"new", "--json", "/proc/gnomon.json"})};
  for (const auto& command : commands) {
    const Ended ended = program.run(command);
    EXPECT_EQ(ended.status, 2) << command[0] << ": " << ended.error;
    EXPECT_NE(ended.error.find("/proc/gnomon"), std::string::npos) << command[0] << ": " << ended.error;
    EXPECT_EQ(program.content(), before) << command[0];
  }
}

// What a run was writing to is taken away under its hands.
TEST(VanishingFolder, OfRenderIsAnError) {
  const Program program("gone-render");
  const pid_t process = program.start({"render", "fence", "--graph", "shadow_mapping", "--size", "64x36",
                                       "--repeat", "60", "--device", "llvmpipe", "--out", "new/a"});
  for (int i = 0; i < 400 && !fs::exists(program.folder() / "new"); ++i)
    std::this_thread::sleep_for(milliseconds(5));
  fs::remove_all(program.folder() / "new");
  const Ended ended = program.wait(process);
  EXPECT_EQ(ended.status, 2) << ended.error;
  EXPECT_FALSE(ended.error.empty());
}

TEST(VanishingFolder, OfBenchEndsItAndSaysThatRowsAreLost) {
  const Program program("gone-bench");
  program.write("suite.json", suite);
  const pid_t process = program.start(with(bench, {"new", "--repeat", "200"}));
  for (int i = 0; i < 400 && !fs::exists(program.folder() / "new" / "results.jsonl"); ++i)
    std::this_thread::sleep_for(milliseconds(5));
  fs::remove_all(program.folder() / "new");
  const Ended ended = program.wait(process);
  EXPECT_TRUE(ended.status == 1 || ended.status == 2) << ended.status;
  EXPECT_NE(ended.error.find("new/results.jsonl"), std::string::npos) << ended.error;
}

TEST(TwoProcesses, OfBenchOneAloneWritesAFolder) {
  const Program program("two-bench"), second("two-bench-second");
  program.write("suite.json", suite);
  const pid_t first = program.start(with(bench, {"out", "--repeat", "200"}));
  for (int i = 0; i < 400 && !fs::exists(program.folder() / "out" / "results.jsonl"); ++i)
    std::this_thread::sleep_for(milliseconds(5));
  const Ended other = second.run({"bench", (program.folder() / "suite.json").string(), "--device", "llvmpipe",
                                  "--resume", "--out", (program.folder() / "out").string()});
  EXPECT_EQ(other.status, 2) << other.error;
  EXPECT_EQ(program.wait(first).status, 0);
  const std::string text = program.read("out/results.jsonl");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 5);
}

TEST(TwoProcesses, OfRenderAndReferenceBothEndWell) {
  const Program program("two-render"), second("two-render-second");
  for (int turn = 0; turn < 5; ++turn) {
    const std::string out = (program.folder() / "out").string(), exr = (program.folder() / "r.exr").string();
    for (const auto& command :
         {with(render, {out}),
          std::vector<std::string>{"reference", "square_plane", "--size", "32x18", "--out", exr}}) {
      const pid_t one = program.start(command), other = second.start(command);
      for (const Ended& ended : {program.wait(one), second.wait(other)})
        EXPECT_EQ(ended.status, 0) << command[0] << ": " << ended.error;
    }
    EXPECT_EQ(read_exr(out + "/visibility.exr").width, 32u);
    EXPECT_EQ(read_exr(exr).width, 32u);
    EXPECT_TRUE(nlohmann::json::accept(program.read("out/run.json")));
  }
  for (const auto& [name, text] : program.content())
    EXPECT_EQ(name.find("unfinished"), std::string::npos) << name;
}

}  // namespace
}  // namespace gnomon::test
