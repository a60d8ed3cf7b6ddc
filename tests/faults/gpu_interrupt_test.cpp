// SIGINT, SIGTERM and SIGKILL at many moments: nothing half-written, rows kept.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/faults/program.h"

namespace gnomon::test {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

const std::vector<std::string> long_render = {"render",   "fence",    "--graph",  "shadow_mapping",
                                              "--size",   "64x36",    "--repeat", "90000",
                                              "--device", "llvmpipe", "--out",    "new/a"};

TEST(Interrupt, ASignalEndsRenderWithNothingLeft) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Program program("render");
    const pid_t process = program.start(long_render);
    std::this_thread::sleep_for(milliseconds(1500));
    kill(process, signal);
    const Ended ended = program.wait(process);
    EXPECT_EQ(ended.status, 128 + signal) << ended.error;
    EXPECT_NE(ended.error.find(signal == SIGINT ? "SIGINT" : "SIGTERM"), std::string::npos) << ended.error;
    EXPECT_TRUE(program.content().empty()) << program.content().begin()->first;
  }
}

TEST(Interrupt, ASignalEndsTheReferenceWithNothingLeft) {
  const Program program("reference");
  const pid_t process = program.start(
      {"reference", "area_shapes", "--samples", "1024", "--size", "1920x1080", "--out", "new.exr"});
  std::this_thread::sleep_for(milliseconds(1500));
  kill(process, SIGINT);
  EXPECT_EQ(program.wait(process).status, 128 + SIGINT);
  EXPECT_TRUE(program.content().empty());
}

constexpr const char* suite =
    R"({"schema": 1, "scenes": [")" GNOMON_TEST_SOURCE_DIR
    R"(/assets/scenes/square_plane.glb"], "size": [32, 18], "repeat": 2, "baseline": "shadow_mapping",
        "graphs": ["shadow_mapping", {"name": "pcf", "set": {"kernel": [3, 5, 7, 9]}}]})";

std::vector<json> rows_of(const Program& program) {
  std::vector<json> rows;
  std::istringstream lines(program.read("out/results.jsonl"));
  for (std::string line; std::getline(lines, line);) rows.push_back(json::parse(line));
  return rows;
}

TEST(Interrupt, BenchKeepsItsRowsAndSaysHowToGoOn) {
  const Program program("bench");
  program.write("suite.json", suite);
  const std::vector<std::string> bench = {"bench", "suite.json", "--out", "out", "--device", "llvmpipe"};
  const pid_t process = program.start([&] {
    std::vector<std::string> slow = bench;
    slow.insert(slow.end(), {"--repeat", "100000"});
    return slow;
  }());
  std::this_thread::sleep_for(milliseconds(2500));
  kill(process, SIGTERM);
  const Ended ended = program.wait(process);
  EXPECT_EQ(ended.status, 128 + SIGTERM) << ended.error;
  EXPECT_NE(ended.error.find("--resume"), std::string::npos) << ended.error;
  std::vector<std::string> resume = bench;
  resume.push_back("--resume");
  const Ended resumed = program.run(resume);
  EXPECT_EQ(resumed.status, 0) << resumed.error;
  EXPECT_EQ(rows_of(program).size(), 5u);
}

// Killed where it happens to be, again and again: every row is whole, and the last run completes them.
TEST(Interrupt, KilledAtFiftyMomentsBenchLosesNoRow) {
  const Program program("killed");
  program.write("suite.json", suite);
  const std::vector<std::string> bench = {"bench",    "suite.json", "--out",   "out",
                                          "--resume", "--device",   "llvmpipe"};
  size_t rows = 0;
  for (int moment = 0; moment < 50; ++moment) {
    const pid_t process = program.start(bench);
    std::this_thread::sleep_for(milliseconds(20 * (moment % 25)));
    kill(process, SIGKILL);
    program.wait(process);
    const std::string text = program.read("out/results.jsonl");
    const size_t now = size_t(std::count(text.begin(), text.end(), '\n'));
    EXPECT_GE(now, rows) << "a row was lost at moment " << moment;
    rows = now;
  }
  EXPECT_EQ(program.run(bench).status, 0);
  EXPECT_EQ(rows_of(program).size(), 5u);
}

}  // namespace
}  // namespace gnomon::test
