// tools/cluster with GNU parallel: the shards of a suite, one that dies on the way, and the merged report.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path source = GNOMON_TEST_SOURCE_DIR;

std::string read_text(const fs::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

class Cluster : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("cluster test ") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    const json suite = {{"scenes", {(source / "assets/scenes/square_plane.glb").string()}},
                        {"size", {32, 18}},
                        {"baseline", "shadow_mapping"},
                        {"graphs",
                         {{{"name", "shadow_mapping"}, {"set", {{"shadow_map", {16, 32}}}}},
                          {{"name", "pcf"}, {"set", {{"shadow_map", 16}, {"kernel", 3}}}}}},
                        {"warmup", 1},
                        {"repeat", 2},
                        {"instrumented", 1}};
    std::ofstream(folder_ / "tiny suite.json") << suite.dump();
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Exit status. `program`: what the scripts take for gnomon. A folder of its own for temporary files keeps
  // the test from waiting for measurements of other people.
  int run(const std::string& arguments, const std::string& program) const {
    const std::string command =
        "cd '" + folder_.string() + "' && TMPDIR='" + folder_.string() + "' GNOMON='" + program + "' '" +
        (source / "tools/cluster/run-parallel").string() + "' " + arguments + " >log 2>&1";
    const int code = std::system(command.c_str());
    return WIFEXITED(code) ? WEXITSTATUS(code) : -1;
  }
  std::string log() const { return read_text(folder_ / "log"); }

  // Stands for a machine that is lost in its first attempt at the second shard.
  std::string failing_program() const {
    const fs::path script = folder_ / "gnomon once";
    std::ofstream(script) << "#!/bin/bash\n"
                          << "if [ \"$4\" = 2/2 ] && mkdir '" << (folder_ / "lost").string()
                          << "' 2>/dev/null; then exit 1; fi\n"
                          << "exec '" GNOMON_EXECUTABLE "' \"$@\"\n";
    fs::permissions(script, fs::perms::owner_all);
    return script.string();
  }

  fs::path folder_;
};

TEST_F(Cluster, ShardsAreMeasuredTriedAgainAndMerged) {
  ASSERT_EQ(run("'tiny suite.json' --shards 2 --out 'all of it' -- --repeat 3", failing_program()), 0)
      << log() << "(tools/install-dependencies --test installs GNU parallel)";
  EXPECT_TRUE(fs::exists(folder_ / "lost"));
  EXPECT_TRUE(fs::exists(folder_ / "all of it" / "report.html"));
  const json report = json::parse(read_text(folder_ / "all of it" / "report.json"));
  std::set<std::string> labels;
  for (const json& row : report["rows"]) labels.insert(row["label"]);
  EXPECT_EQ(labels, (std::set<std::string>{"shadow_mapping shadow_map=16", "shadow_mapping shadow_map=32",
                                           "pcf kernel=3 shadow_map=16"}));
  EXPECT_EQ(report["places"].size(), 1u);
  EXPECT_EQ(report["rows"][0]["ms"]["n"], 3);  // the option after -- arrived
  EXPECT_TRUE(fs::exists(folder_ / "all of it" / "shard-001-of-002" / "results.jsonl"));
  EXPECT_TRUE(fs::exists(folder_ / "all of it" / "shard-002-of-002" / "results.jsonl"));
}

TEST_F(Cluster, BadInputFails) {
  EXPECT_EQ(run("'no such suite.json' --shards 1 --retries 1 --out out", GNOMON_EXECUTABLE), 1);
  EXPECT_NE(log().find("cannot open the suite"), std::string::npos) << log();
  EXPECT_EQ(run("'tiny suite.json' --shards none --out out", GNOMON_EXECUTABLE), 2);
  EXPECT_NE(log().find("usage"), std::string::npos) << log();
}

}  // namespace
}  // namespace gnomon
