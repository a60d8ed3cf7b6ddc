// Killed where they happen to be: what existed before is there as it was, or whole and new.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/image/image.h"
#include "tests/faults/program.h"

namespace gnomon::test {
namespace {

using std::chrono::steady_clock;

struct Killed {
  const char* name;
  std::vector<std::string> arguments;
};
void PrintTo(const Killed& command, std::ostream* out) { *out << command.name; }

const std::vector<Killed> commands = {
    {"render",
     {"render", "square_plane", "--graph", "shadow_mapping", "--size", "32x18", "--repeat", "2", "--out",
      "new", "--json", "new.json", "--device", "llvmpipe"}},
    {"reference", {"reference", "square_plane", "--size", "64x36", "--samples", "16", "--out", "new.exr"}},
    {"report", {"report", "run", "--out", "new"}},
    {"stability",
     {"stability", "--quick", "--graph", "shadow_mapping", "--axis", "flat", "--out", "new", "--overwrite",
      "--json", "new.json", "--device", "llvmpipe"}}};

std::string rows() {
  std::string text;
  for (int i = 0; i < 200; ++i)
    text += nlohmann::json{{"key", std::to_string(i)},
                           {"scene", "s" + std::to_string(i % 20)},
                           {"graph", "g"},
                           {"size", {2, 2}},
                           {"status", "ok"},
                           {"frame_ms", {{"median", i + 1}}},
                           {"error", {{"rmse", 0.1 * i}}}}
                .dump() +
            "\n";
  return text;
}

// Throws what the readers throw when the file is not whole.
void expect_whole(const Program& program, const std::string& name, const std::string& text) {
  const std::filesystem::path file = program.folder() / name;
  if (name.ends_with(".exr") || name.ends_with(".png")) {
    EXPECT_GT(read_image(file).width, 0u) << name;
  } else if (name.ends_with(".json")) {
    EXPECT_TRUE(nlohmann::json::accept(text)) << name;
  } else if (name.ends_with(".html")) {
    EXPECT_TRUE(text.ends_with("</html>\n")) << name;
  } else {
    EXPECT_TRUE(text.empty() || text.back() == '\n') << name;
  }
}

class KilledAnywhere : public testing::TestWithParam<Killed> {};

TEST_P(KilledAnywhere, LeavesWhatWasThereOrWhatIsWhole) {
  const Killed& command = GetParam();
  const Program program(std::string("killed-") + command.name);
  program.write("run/results.jsonl", rows());
  program.write("beside", "before");
  const auto start = steady_clock::now();
  ASSERT_EQ(program.run(command.arguments).status, 0);
  const auto whole = program.content();
  const auto took = steady_clock::now() - start;
  constexpr int moments = 50;
  for (int moment = 0; moment < moments; ++moment) {
    const pid_t process = program.start(command.arguments);
    std::this_thread::sleep_for(took * moment / moments);
    kill(process, SIGKILL);
    program.wait(process);
    std::map<std::string, std::string> now = program.content();
    for (const auto& [name, text] : whole)
      EXPECT_TRUE(now.contains(name)) << name << " is gone at moment " << moment;
    for (const auto& [name, text] : now)
      if (whole.contains(name) && text != whole.at(name)) expect_whole(program, name, text);
    EXPECT_EQ(now["beside"], "before");
    EXPECT_EQ(now["run/results.jsonl"], rows());
  }
  EXPECT_EQ(program.run(command.arguments).status, 0) << "a killed run is in the way of the next";
}

INSTANTIATE_TEST_SUITE_P(Commands, KilledAnywhere, testing::ValuesIn(commands),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace gnomon::test
