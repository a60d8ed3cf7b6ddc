// The harness with made-up techniques: order, pairs, failures, resuming, shards. No device.
#include "bench/run/harness.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "bench/run/output_lock.h"
#include "bench/run/results.h"
#include "bench/run/rounds.h"
#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Takes frame_ms in turn from a list; notes each frame in a shared log.
class Scripted : public Subject {
 public:
  Scripted(std::string name, std::vector<double> ms, std::string& log, int* alive = nullptr)
      : name_(std::move(name)), ms_(std::move(ms)), log_(log), alive_(alive) {
    if (alive_ != nullptr) ++*alive_;
  }
  ~Scripted() override {
    if (alive_ != nullptr) --*alive_;
  }
  FrameTiming render(TimingMode mode) override {
    log_ += name_;
    FrameTiming timing;
    timing.frame_ms = ms_[next_++ % ms_.size()];
    if (timing.frame_ms < 0) throw std::runtime_error("device lost");
    if (mode != TimingMode::none) timing.passes.push_back({"shade", "compose", 0, 1.5, 0.1, 0});
    return timing;
  }

 private:
  std::string name_;
  std::vector<double> ms_;
  std::string& log_;
  int* alive_;
  size_t next_ = 0;
};

TEST(Rounds, TechniquesTakeTurns) {
  std::string log;
  Scripted a("A", {1}, log), b("B", {2}, log), c("C", {3}, log);
  const auto samples = run_rounds({&a, &b, &c}, {1, 2, 0});
  EXPECT_EQ(log, "ABCABCABC");
  EXPECT_EQ(samples[1].frame_ms(), (std::vector<double>{2, 2}));
  EXPECT_TRUE(samples[0].overlapped.empty());
}

TEST(Rounds, StampedFramesDoNotCountAsFrameTime) {
  std::string log;
  Scripted a("A", {1, 2, 3, 100}, log);
  const auto samples = run_rounds({&a}, {1, 2, 3});
  EXPECT_EQ(samples[0].frame_ms(), (std::vector<double>{2, 3}));
  EXPECT_EQ(samples[0].overlapped.size(), 3u);
  EXPECT_EQ(samples[0].isolated.size(), 3u);
}

TEST(Rounds, AFailureLeavesTheOthersAlone) {
  std::string log;
  Scripted a("A", {1, -1}, log), b("B", {2}, log);
  const auto samples = run_rounds({&a, &b}, {0, 4, 0});
  EXPECT_EQ(samples[0].error, "device lost");
  EXPECT_EQ(samples[0].plain.size(), 1u);
  EXPECT_TRUE(samples[1].error.empty());
  EXPECT_EQ(samples[1].plain.size(), 4u);
}

// A takes 1 ms a frame, B 40 ms, within 100 ms: B has its least, three rounds, and one with stamps; A as many
// as there are rounds. B's second warm-up frame fits, and so does the frame that settles the stamps.
TEST(Rounds, ALimitOfTimeLeavesOutTheRoundsOfSlowTechniques) {
  std::string log;
  Scripted a("A", {1}, log), b("B", {40}, log);
  RoundSettings settings{2, 5, 2};
  settings.seconds = 0.1;
  settings.least = 3;
  double last = 0;
  const auto samples = run_rounds({&a, &b}, settings, [&](double share) { last = share; });
  EXPECT_EQ(samples[0].plain.size(), 5u);
  EXPECT_EQ(samples[1].plain.size(), 3u);
  EXPECT_EQ(samples[0].overlapped.size(), 2u);
  EXPECT_EQ(samples[1].overlapped.size(), 2u);
  EXPECT_EQ(log.substr(0, 4 + 8), "ABABABABABAA");
  EXPECT_DOUBLE_EQ(last, 1);
}

TEST(Rounds, AFrameLongerThanTheLimitIsTakenTheLeastNumberOfTimes) {
  std::string log;
  Scripted a("A", {500}, log);
  RoundSettings settings{3, 9, 4};
  settings.seconds = 0.1;
  settings.least = 2;
  const auto samples = run_rounds({&a}, settings);
  EXPECT_EQ(samples[0].plain.size(), 2u);
  EXPECT_EQ(samples[0].overlapped.size(), 1u);
  EXPECT_EQ(samples[0].isolated.size(), 1u);
  EXPECT_EQ(log, "AAAAA");  // one to warm up, none to settle
}

TEST(Rounds, TheBaselineStaysAsLongAsAnyOther) {
  std::string log;
  Scripted a("A", {500}, log), b("B", {20}, log);
  RoundSettings settings{1, 4, 0};
  settings.seconds = 0.1;
  settings.least = 1;
  settings.baseline = 0;
  const auto samples = run_rounds({&a, &b}, settings);
  EXPECT_EQ(samples[1].plain.size(), 4u);
  EXPECT_EQ(samples[0].plain.size(), 4u);
}

TEST(Rounds, SequencesHaveNoLimit) {
  std::string log;
  Scripted a("A", {500}, log);
  RoundSettings settings{1, 4, 0, true};
  settings.seconds = 0.1;
  settings.least = 1;
  EXPECT_EQ(run_rounds({&a}, settings)[0].plain.size(), 4u);
}

TEST(Rounds, ProgressEndsAtOne) {
  std::string log;
  Scripted a("A", {1}, log);
  double last = 0;
  run_rounds({&a}, {2, 3, 1}, [&](double share) {
    EXPECT_GE(share, last);
    last = share;
  });
  EXPECT_DOUBLE_EQ(last, 1);
}

class HarnessTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("harness_test_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    suite_.name = "made_up";
    suite_.file = folder_ / "made_up.json";
    suite_.scenes = {folder_ / "one.glb", folder_ / "two.glb"};
    suite_.sizes = {{64, 36}};
    suite_.baseline = "base";
    suite_.warmup = 1;
    suite_.repeat = 3;
    suite_.instrumented = 1;
    for (const fs::path& scene : suite_.scenes) std::ofstream(scene) << "x";
    add("base", 0);
    options_.out = folder_ / "out";
    options_.device = {"made-up device", "driver 1", true};
  }
  void TearDown() override { fs::remove_all(folder_); }

  void add(const std::string& name, size_t baseline) {
    SuiteConfig config;
    config.graph.name = name;
    config.entry = suite_.configs.size();
    config.baseline = baseline;
    config.sizes = suite_.sizes;
    suite_.configs.push_back(config);
  }

  // Frame times by graph name; a name that is not there fails to open.
  struct MadeUpStage : Stage {
    HarnessTest& test;
    explicit MadeUpStage(HarnessTest& owner) : test(owner) {}
    std::unique_ptr<Subject> open(const SuiteConfig& config) override {
      const auto found = test.ms_.find(config.graph.name);
      if (found == test.ms_.end()) fail("cannot run here", config.graph.name);
      auto subject = std::make_unique<Scripted>(config.graph.name, found->second, test.log_, &test.alive_);
      test.most_alive_ = std::max(test.most_alive_, test.alive_);
      return subject;
    }
    void frame(const SuiteConfig& config, Subject&, uint32_t index, double) override {
      test.frames_ += config.graph.name + std::to_string(index) + " ";
    }
    void finish(const SuiteConfig&, Subject&, Row& row) override {
      row.error.emplace().all.misclassified = 0.25;
      if (test.large_rows_) row.warnings = {std::string(1 << 20, 'x')};
      row.nonfinite = test.nonfinite_;
    }
  };
  StageMaker stages() {
    return [this](const Suite&, const SuitePlace& place) -> std::unique_ptr<Stage> {
      if (place.scene.stem() == broken_scene_) fail("not a glTF file", place.scene.string());
      return std::make_unique<MadeUpStage>(*this);
    };
  }
  BenchResult run() { return run_suite(suite_, options_, stages()); }
  std::vector<json> rows() const { return read_lines(options_.out / "results.jsonl"); }

  fs::path folder_;
  Suite suite_;
  BenchOptions options_;
  std::map<std::string, std::vector<double>> ms_{{"base", {2}}};
  std::string log_, broken_scene_, frames_;
  int alive_ = 0, most_alive_ = 0;
  uint64_t nonfinite_ = 0;
  bool large_rows_ = false;
};

TEST_F(HarnessTest, RowHasTheStatedFields) {
  run();
  ASSERT_EQ(rows().size(), 2u);
  const json row = rows()[0];
  for (const char* field :
       {"scene", "graph", "vars", "size", "device", "driver", "frame_ms", "passes", "error", "light_samples",
        "memory", "left_out", "nonfinite", "status", "ratio", "warnings", "facts", "gnomon", "key"})
    EXPECT_TRUE(row.contains(field)) << field;
  EXPECT_EQ(row["scene"], "one");
  EXPECT_EQ(row["size"], (json{64, 36}));
  EXPECT_EQ(row["status"], "ok");
  EXPECT_EQ(row["frame_ms"]["n"], 3);
  EXPECT_EQ(row["frame_ms"]["median"], 2);
  EXPECT_EQ(row["frame_ms"]["ci95"].size(), 2u);
  EXPECT_EQ(row["error"]["misclassified"], 0.25);
  ASSERT_EQ(row["passes"].size(), 1u);
  EXPECT_EQ(row["passes"][0]["id"], "shade");
  EXPECT_EQ(row["passes"][0]["gpu_ms"]["isolated"]["median"], 1.5);
  EXPECT_EQ(row["ratio"]["median"], 1);
  EXPECT_EQ(row["baseline"], true);
}

TEST_F(HarnessTest, RowsAreReadAsTheyWereWritten) {
  add("other", 0);
  ms_ = {{"base", {2}}, {"other", {4}}};
  run();
  const auto written = rows();
  const auto read = read_results(options_.out / "results.jsonl");
  ASSERT_EQ(read.size(), written.size());
  for (size_t i = 0; i < read.size(); ++i) EXPECT_EQ(to_json(read[i]), written[i]) << i;
  EXPECT_FALSE(read[1].is_baseline);
  EXPECT_EQ(read[1].ratio->baseline, label_of(read[0]));
}

// A file-size limit stands for a full disk: the row that does not fit ends the suite, the others are kept.
TEST_F(HarnessTest, FullDiskEndsTheSuiteAndKeepsTheRows) {
  add("other", 0);
  ms_ = {{"base", {2}}, {"other", {4}}};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  StageMaker maker = stages();
  const auto limited = [&](const Suite& suite, const SuitePlace& place) {
    if (place.scene.stem() == "two") {
      large_rows_ = true;
      const rlimit low{256 << 10, before.rlim_max};
      setrlimit(RLIMIT_FSIZE, &low);
    }
    return maker(suite, place);
  };
  const BenchResult result = run_suite(suite_, options_, limited);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(result.stopped.find("cannot write"), std::string::npos) << result.stopped;
  EXPECT_EQ(result.measured, 2u);
  EXPECT_EQ(rows().size(), 2u);
  large_rows_ = false;
  options_.resume = true;
  const BenchResult rest = run();
  EXPECT_EQ(rest.stopped, "");
  EXPECT_EQ(rest.resumed, 2u);
  EXPECT_EQ(rows().size(), 4u);
}

TEST_F(HarnessTest, AFolderBelongsToOneRunAtATime) {
  {
    const OutputLock other(options_.out);
    try {
      run();
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("process " + std::to_string(getpid())), std::string::npos)
          << error.what();
    }
    EXPECT_FALSE(fs::exists(options_.out / "results.jsonl"));
  }
  std::ofstream(options_.out / "in-use") << "process 1 on a machine that has died\n";  // and its lock with it
  EXPECT_EQ(run().measured, 2u);
  EXPECT_FALSE(fs::exists(options_.out / "in-use"));
}

TEST_F(HarnessTest, LightScalesArePlacesOfTheirOwn) {
  add("other", 0);
  ms_ = {{"base", {2}}, {"other", {4}}};
  suite_.scenes.resize(1);
  suite_.configs[1].light_scales = {1, 0.5};
  run();
  ASSERT_EQ(rows().size(), 3u);
  EXPECT_EQ(rows()[1]["light_scale"], 1);
  EXPECT_EQ(rows()[2]["light_scale"], 0.5);
  EXPECT_EQ(rows()[2]["graph"], "other");
  EXPECT_EQ(rows()[2]["ratio"]["median"], 2);  // the baseline runs there, too, for the ratio alone
  EXPECT_NE(rows()[1]["key"], rows()[2]["key"]);
}

TEST_F(HarnessTest, RatioIsTheMedianOverPairs) {
  add("other", 0);
  // Warm-up, then three rounds: ratios 3, 1, 2. The ratio of the medians would be 20 / 10.
  ms_ = {{"base", {1, 1, 100, 10}}, {"other", {1, 3, 100, 20}}};
  run();
  const json row = rows()[1];
  EXPECT_EQ(row["graph"], "other");
  EXPECT_EQ(row["ratio"]["median"], 2);
  EXPECT_EQ(row["ratio"]["baseline"], "base");
}

TEST_F(HarnessTest, SequencesAreMeasuredInTurnWithTheBaselineAlone) {
  add("other", 0);
  ms_ = {{"base", {1}}, {"other", {2}}};
  suite_.scenes.resize(1);
  run();
  EXPECT_EQ(frames_, "");
  const std::string key = rows()[0]["key"];
  suite_.frames = 2;
  suite_.instrumented = 0;
  options_.overwrite = true;
  log_.clear();
  run();
  EXPECT_EQ(frames_, "base0 base1 other0 other1 ");
  EXPECT_EQ(log_,
            "base"
            "basebase"
            "baseother"
            "baseotherbaseother");  // a frame to warm up first
  EXPECT_EQ(rows()[0]["frame_ms"]["n"], 2);
  EXPECT_NE(rows()[0]["key"], key);
}

TEST_F(HarnessTest, FailureIsARowAndTheSuiteGoesOn) {
  add("cannot_open", 0);
  add("dies", 0);
  add("fine", 0);
  ms_ = {{"base", {2}}, {"dies", {1, -1}}, {"fine", {4}}};
  const BenchResult result = run();
  EXPECT_EQ(result.measured, 8u);
  EXPECT_EQ(result.failed, 4u);
  const auto all = rows();
  EXPECT_NE(all[1]["status"].get<std::string>().find("cannot run here"), std::string::npos);
  EXPECT_NE(all[2]["status"].get<std::string>().find("device lost"), std::string::npos);
  EXPECT_EQ(all[3]["status"], "ok");
  EXPECT_EQ(all[3]["ratio"]["median"], 2);
}

TEST_F(HarnessTest, FailedBaselineLeavesNoRatio) {
  add("fine", 0);
  ms_ = {{"fine", {4}}};
  run();
  EXPECT_EQ(rows()[1]["status"], "ok");
  EXPECT_TRUE(rows()[1]["ratio"].is_null());
}

TEST_F(HarnessTest, BrokenSceneGivesRowsThatSayWhy) {
  broken_scene_ = "one";
  const BenchResult result = run();
  EXPECT_EQ(result.failed, 1u);
  EXPECT_NE(rows()[0]["status"].get<std::string>().find("not a glTF file"), std::string::npos);
  EXPECT_EQ(rows()[1]["status"], "ok");
}

TEST_F(HarnessTest, NonFiniteOutputIsAFailure) {
  nonfinite_ = 3;
  const BenchResult result = run();
  EXPECT_EQ(result.failed, 2u);
  EXPECT_EQ(rows()[0]["nonfinite"], 3);
  EXPECT_NE(rows()[0]["status"], "ok");
}

TEST_F(HarnessTest, ChunksKeepTheBaselineAndTheMemoryBound) {
  options_.max_alive = 3;
  suite_.scenes.resize(1);
  for (const char* name : {"b", "c", "d", "e", "f"}) {
    add(name, 0);
    ms_[name] = {4};
  }
  run();
  EXPECT_LE(most_alive_, 3);
  EXPECT_EQ(alive_, 0);
  const auto all = rows();
  ASSERT_EQ(all.size(), 6u);
  for (size_t i = 1; i < all.size(); ++i) EXPECT_EQ(all[i]["ratio"]["median"], 2) << i;
}

TEST_F(HarnessTest, ResumeSkipsWhatIsThere) {
  run();
  log_.clear();
  options_.resume = true;
  const BenchResult again = run();
  EXPECT_EQ(again.resumed, 2u);
  EXPECT_EQ(again.measured, 0u);
  EXPECT_EQ(log_, "");
  EXPECT_EQ(rows().size(), 2u);
}

TEST_F(HarnessTest, ResumeAfterATornLineMeasuresOnlyWhatIsMissing) {
  run();
  const fs::path file = options_.out / "results.jsonl";
  fs::resize_file(file, fs::file_size(file) - 20);
  EXPECT_EQ(rows().size(), 1u);
  options_.resume = true;
  const BenchResult again = run();
  EXPECT_EQ(again.resumed, 1u);
  EXPECT_EQ(again.measured, 1u);
  ASSERT_EQ(rows().size(), 2u);
  EXPECT_EQ(rows()[1]["scene"], "two");
}

// Base, b and c take turns: a frame each to warm up, three rounds, a frame each to settle the stamps and one
// of each mode.
class InterruptedTest : public HarnessTest {
 protected:
  void SetUp() override {
    HarnessTest::SetUp();
    add("b", 0);
    add("c", 0);
    ms_ = {{"base", {2}}, {"b", {4}}, {"c", {8}}};
    suite_.scenes.resize(1);
  }
  void interrupt_after(const std::string& log) {
    options_.progress = [this, log](double, const std::string&) {
      if (log_ == log) throw std::runtime_error("interrupted");
    };
    EXPECT_THROW(run(), std::runtime_error);
    options_.progress = {};
    log_.clear();
    options_.resume = true;
    ms_ = {{"base", {20}}, {"b", {40}}, {"c", {80}}};
  }
  fs::path kept() const { return options_.out / "interrupted.jsonl"; }
};

TEST_F(InterruptedTest, ResumeGoesOnInTheMiddleOfARound) {
  interrupt_after(
      "basebc"
      "basebc"
      "baseb");
  EXPECT_EQ(rows().size(), 0u);
  const BenchResult again = run();
  EXPECT_EQ(again.measured, 3u);
  EXPECT_EQ(log_,
            "basebc"
            "c"
            "basebc"
            "basebcbasebc"
            "basebcbasebc");
  ASSERT_EQ(rows().size(), 3u);
  for (const json& row : rows()) EXPECT_EQ(row["frame_ms"]["n"], 3);
  EXPECT_EQ(rows()[0]["frame_ms"]["median"], 2);
  EXPECT_EQ(rows()[1]["frame_ms"]["ci95"], (json{4, 40}));
  EXPECT_EQ(rows()[2]["frame_ms"]["median"], 80);
  EXPECT_EQ(rows()[1]["ratio"]["median"], 2);
  EXPECT_FALSE(fs::exists(kept()));
}

TEST_F(InterruptedTest, ResumeTakesFramesWithStampsAsTheyWere) {
  interrupt_after(
      "basebc"
      "basebcbasebcbasebc"
      "basebcbasebc"
      "basebcbase");
  run();
  EXPECT_EQ(log_,
            "basebc"
            "basebc"
            "basebc"
            "bc");
  for (const json& row : rows()) {
    EXPECT_EQ(row["passes"][0]["type"], "compose");
    EXPECT_EQ(row["passes"][0]["gpu_ms"]["overlapped"]["n"], 1);
    EXPECT_EQ(row["passes"][0]["gpu_ms"]["isolated"]["median"], 1.5);
    EXPECT_EQ(row["passes"][0]["cpu_ms"], 0.1);
  }
}

// The row that was written is not measured again, and still counts as one of those that took turns.
TEST_F(InterruptedTest, ResumeBetweenTheRowsOfATurnMeasuresNoFrameAgain) {
  run();
  const fs::path results = options_.out / "results.jsonl";
  std::ifstream stream(results);
  std::string first;
  std::getline(stream, first);
  log_.clear();
  options_.overwrite = true;
  interrupt_after(
      "basebc"
      "basebcbasebcbasebc"
      "basebcbasebc"
      "basebcbasebc");
  std::ofstream(results) << first << "\n";
  const BenchResult again = run();
  EXPECT_EQ(again.resumed, 1u);
  EXPECT_EQ(again.measured, 2u);
  EXPECT_EQ(log_,
            "basebc"
            "basebc"
            "basebc");
  EXPECT_EQ(rows()[2]["frame_ms"]["median"], 8);
}

TEST_F(InterruptedTest, FramesOfOtherTechniquesAreThrownAway) {
  interrupt_after(
      "basebc"
      "basebc"
      "baseb");
  suite_.repeat = 2;
  run();
  EXPECT_EQ(rows()[0]["frame_ms"]["median"], 20);
}

TEST_F(InterruptedTest, ATornLastFrameIsMeasuredAgain) {
  interrupt_after(
      "basebc"
      "basebc"
      "baseb");
  fs::resize_file(kept(), fs::file_size(kept()) - 20);
  run();
  EXPECT_EQ(log_.substr(0, 9),
            "basebc"
            "bc"
            "b");
  EXPECT_EQ(rows()[1]["frame_ms"]["median"], 40);
}

TEST_F(InterruptedTest, AFileThatHoldsNoFramesIsAnError) {
  interrupt_after(
      "basebc"
      "basebc"
      "baseb");
  std::ofstream(kept()) << "{\"group\": 3}\n";
  EXPECT_THROW(run(), Error);
}

TEST_F(InterruptedTest, ASequenceBeginsAnewAndLosesItsOwnRowAlone) {
  suite_.frames = 3;
  // The baseline by itself, then b: a frame each to warm up, and two of the three that count.
  interrupt_after(
      "base"
      "basebasebase"
      "basebase"
      "basebase"
      "baseb"
      "basebbaseb");
  EXPECT_EQ(rows().size(), 1u);
  run();
  EXPECT_EQ(log_.substr(0, 20),
            "baseb"
            "basebbasebbaseb");
  EXPECT_EQ(rows().size(), 3u);
  EXPECT_EQ(rows()[0]["frame_ms"]["median"], 2);
  EXPECT_EQ(rows()[1]["frame_ms"]["median"], 40);
}

TEST_F(HarnessTest, ResumeMeasuresFailedRowsAgain) {
  broken_scene_ = "one";
  run();
  broken_scene_.clear();
  options_.resume = true;
  const BenchResult again = run();
  EXPECT_EQ(again.measured, 1u);
  ASSERT_EQ(rows().size(), 2u);
  for (const json& row : rows()) EXPECT_EQ(row["status"], "ok");
}

TEST_F(HarnessTest, ChangedSettingsAreMeasuredAnew) {
  run();
  options_.resume = true;
  suite_.repeat = 4;
  EXPECT_EQ(run().measured, 2u);
}

TEST_F(HarnessTest, ALimitOfTimeKeepsPairsWithTheBaseline) {
  add("slow", 0);
  ms_ = {{"base", {10}}, {"slow", {60}}};
  suite_.scenes.resize(1);
  suite_.repeat = 8;
  suite_.seconds = 0.2;
  suite_.least = 2;
  run();
  EXPECT_EQ(rows()[0]["frame_ms"]["n"], 8);
  EXPECT_EQ(rows()[1]["frame_ms"]["n"], 3);
  EXPECT_EQ(rows()[1]["ratio"]["n"], 3);
  EXPECT_EQ(rows()[1]["ratio"]["median"], 6);
  EXPECT_TRUE(rows()[1]["harness_seconds"].contains("frames"));
  EXPECT_EQ(json::parse(std::ifstream(options_.out / "suite.json"))["seconds"], 0.2);
}

TEST_F(HarnessTest, ResultsAreNotOverwrittenUnasked) {
  run();
  EXPECT_THROW(run(), Error);
  EXPECT_EQ(rows().size(), 2u);
  options_.overwrite = true;
  EXPECT_EQ(run().measured, 2u);
}

TEST_F(HarnessTest, ShardsAreDisjointAndComplete) {
  add("b", 0);
  add("c", 0);
  ms_["b"] = ms_["c"] = {4};
  std::multiset<std::string> seen;
  for (uint32_t shard = 1; shard <= 4; ++shard) {
    options_.shard = shard;
    options_.shards = 4;
    options_.out = folder_ / ("shard" + std::to_string(shard));
    run();
    for (const json& row : rows()) {
      seen.insert(row["key"]);
      EXPECT_TRUE(row["ratio"].is_object());
    }
  }
  EXPECT_EQ(seen.size(), 6u);
  EXPECT_EQ(std::set<std::string>(seen.begin(), seen.end()).size(), 6u);
}

TEST_F(HarnessTest, BadShardIsAnError) {
  options_.shard = 3;
  options_.shards = 2;
  EXPECT_THROW(run(), Error);
}

TEST(Results, ALineInTheMiddleThatIsNotJsonIsAnError) {
  const fs::path file = fs::path(testing::TempDir()) / "broken_results.jsonl";
  std::ofstream(file) << "{}\nnot json\n{}\n";
  try {
    read_results(file);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("line 2"), std::string::npos);
  }
  fs::remove(file);
}

TEST(Results, FullDiskIsAnErrorAndTakesTheRowBack) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  ResultsFile file("/dev/full", true);
  EXPECT_THROW(file.append(json{{"a", 1}}), Error);
}

}  // namespace
}  // namespace gnomon
