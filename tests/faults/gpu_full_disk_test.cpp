// The disk becomes full at each write in turn: the exit status says so, and nothing half-written remains.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/faults/program.h"

namespace gnomon::test {
namespace {

struct Command {
  const char* name;
  std::vector<std::string> arguments;
  bool keeps_rows = false;  // what was finished before stays
};

void PrintTo(const Command& command, std::ostream* out) { *out << command.name; }

class FullDisk : public testing::TestWithParam<Command> {};

const std::vector<Command> commands = {
    {"reference", {"reference", "square_plane", "--size", "16x9", "--out", "new.exr"}},
    {"generate", {"scene", "generate", "fence", "--out", "scenes"}},
    {"edt", {"edt", "mask.png", "new.exr", "--device", "llvmpipe"}},
    {"render",
     {"render", "square_plane", "--graph", "shadow_mapping", "--size", "16x9", "--repeat", "1", "--out",
      "new", "--json", "new.json", "--device", "llvmpipe"}},
    {"report", {"report", "run", "--out", "new"}},
    {"bench", {"bench", "suite.json", "--out", "new", "--device", "llvmpipe"}, true}};

void fill(const Program& program) {
  // 1 x 1 pixel, 8-bit gray, as PNG.
  const unsigned char png[] = {
      0x89, 'P',  'N',  'G',  '\r', '\n', 0x1a, '\n', 0,    0,    0,    13,   'I',  'H',  'D',  'R',  0,
      0,    0,    1,    0,    0,    0,    1,    8,    0,    0,    0,    0,    0x3a, 0x7e, 0x9b, 0x55, 0,
      0,    0,    10,   'I',  'D',  'A',  'T',  0x78, 0x9c, 0x63, 0xf8, 0x0f, 0,    0x01, 0x01, 0x01, 0,
      0x1b, 0xb6, 0xee, 0x56, 0,    0,    0,    0,    'I',  'E',  'N',  'D',  0xae, 0x42, 0x60, 0x82};
  program.write("mask.png", std::string(reinterpret_cast<const char*>(png), sizeof png));
  program.write("suite.json", R"({"schema": 1, "scenes": [")" GNOMON_TEST_SOURCE_DIR
                              R"(/assets/scenes/square_plane.glb"], "size": [16, 9], "repeat": 1,
                                  "baseline": "shadow_mapping", "graphs": ["shadow_mapping"]})");
  const nlohmann::json row = {{"key", "a"},
                              {"scene", "s"},
                              {"graph", "g"},
                              {"size", {2, 2}},
                              {"status", "ok"},
                              {"frame_ms", {{"median", 1}}},
                              {"error", {{"rmse", 0.1}}}};
  program.write("run/results.jsonl", row.dump() + "\n");
}

TEST_P(FullDisk, LeavesNothingHalfWritten) {
  const Command& command = GetParam();
  const Program whole(std::string("whole-") + command.name);
  fill(whole);
  ASSERT_EQ(whole.run(command.arguments).status, 0);
  constexpr int most_writes = 200;  // more than any of the commands makes
  int writes = 0;
  for (; writes < most_writes; ++writes) {
    const Program program(std::string("full-") + command.name);
    fill(program);
    const auto before = program.content();
    const Ended ended = program.run(
        command.arguments, {"LD_PRELOAD=" GNOMON_FULL_DISK, "GNOMON_FULL_AFTER=" + std::to_string(writes)});
    if (ended.status == 0) {
      EXPECT_EQ(program.content().size(), whole.content().size()) << "status 0 without all of the results";
      break;
    }
    EXPECT_TRUE(ended.status == 1 || ended.status == 2) << ended.status << " after " << writes << " writes";
    EXPECT_FALSE(ended.error.empty());
    for (const auto& [name, text] : before) EXPECT_EQ(program.content()[name], text) << name;
    if (!command.keeps_rows) {
      EXPECT_EQ(program.content(), before) << "after " << writes << " writes";
    }
  }
  EXPECT_GT(writes, 0);
  EXPECT_LT(writes, most_writes);
}

INSTANTIATE_TEST_SUITE_P(Commands, FullDisk, testing::ValuesIn(commands),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace gnomon::test
