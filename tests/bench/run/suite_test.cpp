// Suite files: sweeps, sizes, and every mistake with its place.
#include "bench/run/suite.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

// A folder with two empty scene files: a suite looks only whether they are there.
class SuiteTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("suite_test_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "more");
    for (const char* name : {"b.glb", "a.glb", "more/c.gltf", "more/readme.txt"})
      std::ofstream(folder_ / name) << "x";
    setenv("GNOMON_SCENES", (folder_ / "absent").c_str(), 1);
  }
  void TearDown() override {
    unsetenv("GNOMON_SCENES");
    fs::remove_all(folder_);
  }
  Suite parse(const std::string& text) const { return parse_suite(text, folder_ / "suite.json"); }
  // Every problem's text in one string; empty when the suite is right.
  std::string problems(const std::string& text) const {
    try {
      parse(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  std::vector<std::string> names(const Suite& suite) const {
    std::vector<std::string> all;
    for (const fs::path& scene : suite.scenes) all.push_back(scene.filename().string());
    return all;
  }
  fs::path folder_;
};

TEST_F(SuiteTest, LightsMayBeScaled) {
  const Suite suite = parse(R"({ "schema": 1, "scenes": ["a.glb"], "light_scale": 2,
    "graphs": ["shadow_mapping", { "name": "rbsm_conservative", "light_scale": [0, 0.5, 2] }] })");
  EXPECT_EQ(suite.configs[0].light_scales, std::vector<double>{2});
  EXPECT_EQ(suite.configs[1].light_scales, (std::vector<double>{0, 0.5, 2}));
  EXPECT_EQ(all_light_scales(suite), (std::vector<double>{2, 0, 0.5}));
  for (const char* wrong : {"-1", "\"2\"", "[]", "[1, null]", "1e300"})
    EXPECT_NE(problems(std::string(R"({ "schema": 1, "scenes": ["a.glb"], "light_scale": )") + wrong +
                       R"(, "graphs": ["shadow_mapping"] })")
                  .find("/light_scale"),
              std::string::npos)
        << wrong;
}

TEST_F(SuiteTest, GraphsMayHaveSizesOfTheirOwn) {
  const Suite suite = parse(R"({ "schema": 1, "scenes": ["a.glb"], "size": [64, 36],
    "graphs": ["shadow_mapping", { "name": "rbsm_conservative", "size": [[32, 18], [64, 36]] }] })");
  const Extent small{32, 18}, usual{64, 36};
  EXPECT_EQ(suite.configs[0].sizes, std::vector<Extent>{usual});
  EXPECT_EQ(suite.configs[1].sizes, (std::vector<Extent>{small, usual}));
  EXPECT_EQ(all_sizes(suite), (std::vector<Extent>{usual, small}));
  EXPECT_NE(
      problems(
          R"({ "schema": 1, "scenes": ["a.glb"], "graphs": [{ "name": "shadow_mapping", "size": [0, 1] }] })")
          .find("/graphs/0/size"),
      std::string::npos);
}

TEST_F(SuiteTest, DesignsExample) {
  const Suite suite =
      parse(R"({ "schema": 1, "scenes": ["a.glb"], "size": [1280, 720], "baseline": "shadow_mapping",
    "graphs": ["shadow_mapping", { "name": "rbsm_conservative", "set": { "shadow_map": [512, 1024] } }] })");
  EXPECT_EQ(suite.name, "suite");
  ASSERT_EQ(suite.sizes.size(), 1u);
  EXPECT_EQ(suite.sizes[0], (Extent{1280, 720}));
  ASSERT_EQ(suite.configs.size(), 3u);
  EXPECT_EQ(suite.configs[0].graph.name, "shadow_mapping");
  EXPECT_EQ(suite.configs[1].set.at("shadow_map"), Value(std::int64_t(512)));
  EXPECT_EQ(suite.configs[2].set.at("shadow_map"), Value(std::int64_t(1024)));
  for (const SuiteConfig& config : suite.configs) EXPECT_EQ(config.baseline, 0u);
}

TEST_F(SuiteTest, SweepIsEveryCombination) {
  const Suite suite = parse(R"({ "scenes": ["a.glb"], "graphs": [
    { "name": "shadow_mapping", "set": { "depth": ["perspective", "linear"], "shadow_map": [512, 1024, 2048] } }] })");
  EXPECT_EQ(suite.configs.size(), 6u);
  EXPECT_EQ(suite.configs[4].graph.vars.at("shadow_map"), suite.configs[4].set.at("shadow_map"));
}

TEST_F(SuiteTest, BaselineHasTheSameMapSize) {
  const Suite suite = parse(R"({ "scenes": ["a.glb"], "baseline": "shadow_mapping", "graphs": [
    { "name": "rbsm_conservative", "set": { "shadow_map": [512, 1024] } },
    { "name": "shadow_mapping", "set": { "shadow_map": [512, 1024, 2048] } },
    { "name": "shadow_mapping", "set": { "depth": "linear", "shadow_map": [512, 1024] } },
    "shadow_volumes"] })");
  ASSERT_EQ(suite.configs.size(), 8u);
  const std::vector<size_t> expected = {2, 3, 2, 3, 4, 2, 3, 3};  // the last: the graph's default, 1024
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(suite.configs[i].baseline, expected[i]) << i;
}

TEST_F(SuiteTest, PatternsFoldersAndRepetitions) {
  const Suite suite = parse(R"({ "scenes": ["b.glb", "*.glb", "more"], "graphs": ["shadow_mapping"] })");
  EXPECT_EQ(names(suite), (std::vector<std::string>{"b.glb", "a.glb", "c.gltf"}));
}

TEST_F(SuiteTest, MissingRealScenesAreANotice) {
  const Suite suite =
      parse(R"({ "scenes": ["a.glb", "$GNOMON_SCENES/*.glb"], "graphs": ["shadow_mapping"] })");
  EXPECT_EQ(names(suite), std::vector<std::string>{"a.glb"});
  ASSERT_EQ(suite.notices.size(), 1u);
  EXPECT_NE(suite.notices[0].find("GNOMON_SCENES"), std::string::npos);
}

TEST_F(SuiteTest, RealScenesComeFromTheEnvironment) {
  setenv("GNOMON_SCENES", folder_.c_str(), 1);
  const Suite suite = parse(R"({ "scenes": ["$GNOMON_SCENES/*.glb"], "graphs": ["shadow_mapping"] })");
  EXPECT_EQ(names(suite), (std::vector<std::string>{"a.glb", "b.glb"}));
}

TEST_F(SuiteTest, SeveralSizes) {
  const Suite suite =
      parse(R"({ "scenes": ["a.glb"], "size": [[640, 360], [64, 36]], "graphs": ["shadow_mapping"] })");
  EXPECT_EQ(suite.sizes.size(), 2u);
}

TEST_F(SuiteTest, Sequences) {
  const Suite none = parse(R"({ "schema": 1, "scenes": ["a.glb"], "graphs": ["shadow_mapping"] })");
  EXPECT_EQ(none.frames, 0u);
  const Suite suite =
      parse(R"({ "schema": 1, "scenes": ["a.glb"], "frames": 60, "fps": 24, "graphs": ["shadow_mapping"] })");
  EXPECT_EQ(suite.frames, 60u);
  EXPECT_EQ(suite.fps, 24);
  for (const char* bad : {R"("frames": -1)", R"("fps": 0)", R"("fps": -30)", R"("frames": 0.5)"})
    EXPECT_NE(problems(std::string(R"({ "schema": 1, "scenes": ["a.glb"], "graphs": ["pcf"], )") + bad + "}"),
              "")
        << bad;
}

TEST_F(SuiteTest, EveryProblemIsToldWithItsPlace) {
  const std::string text = problems(R"({ "scenes": ["absent.glb"], "size": [0, 720], "repeat": 0, "grphs": [],
    "graphs": ["shadow_maping", { "name": "shadow_mapping", "set": { "shadow_mop": 512 } }] })");
  for (const char* piece :
       {"absent.glb", "/scenes/0", "/size", "/repeat", "grphs", "shadow_maping", "shadow_mop"})
    EXPECT_NE(text.find(piece), std::string::npos) << piece << " in\n" << text;
}

TEST_F(SuiteTest, BadSuitesAreErrors) {
  const char* const bad[] = {
      "",
      "[]",
      "{",
      R"({ "scenes": [], "graphs": ["shadow_mapping"] })",
      R"({ "scenes": "a.glb", "graphs": ["shadow_mapping"] })",
      R"({ "scenes": [1], "graphs": ["shadow_mapping"] })",
      R"({ "scenes": ["a.glb"] })",
      R"({ "scenes": ["a.glb"], "graphs": [] })",
      R"({ "scenes": ["a.glb"], "graphs": [7] })",
      R"({ "scenes": ["a.glb"], "graphs": [{}] })",
      R"({ "scenes": ["a.glb"], "graphs": ["shadow_mapping"], "size": [1280] })",
      R"({ "scenes": ["a.glb"], "graphs": ["shadow_mapping"], "size": [99999, 720] })",
      R"({ "scenes": ["a.glb"], "graphs": ["shadow_mapping"], "size": "1280x720" })",
      R"({ "scenes": ["a.glb"], "graphs": ["shadow_mapping"], "baseline": "nobody" })",
      R"({ "scenes": ["a.glb"], "graphs": ["shadow_mapping"], "schema": 2 })",
      R"({ "scenes": ["a.glb"], "graphs": ["shadow_mapping"], "reference": 5 })",
      R"({ "scenes": ["a.glb"], "graphs": ["shadow_mapping"], "seconds": -1 })",
      R"({ "scenes": ["a.glb"], "graphs": ["shadow_mapping"], "least": 0 })",
      R"({ "scenes": ["a.glb"], "graphs": ["shadow_mapping"], "graphs": ["shadow_mapping"] })",
      R"({ "scenes": ["$GNOMON_SCENES/*.glb"], "graphs": ["shadow_mapping"] })",
  };
  for (const char* text : bad) EXPECT_NE(problems(text), "") << text;
}

TEST_F(SuiteTest, ShippedSuitesAreRight) {
  for (const char* name : {"demo", "hard", "bias"}) {
    const Suite suite = load_suite(find_suite(name));
    EXPECT_FALSE(suite.scenes.empty()) << name;
    EXPECT_EQ(suite.baseline, "shadow_mapping") << name;
  }
}

TEST_F(SuiteTest, TheFullSuiteHoldsEveryTechniqueAtThreeMapSizesOnSixScenes) {
  const Suite suite = load_suite(find_suite("full"));
  EXPECT_EQ(suite.scenes.size(), 6u);
  EXPECT_GT(suite.seconds, 0);
  for (const fs::path& file : all_graphs()) {
    std::set<std::int64_t> maps;
    size_t rows = 0;
    for (const SuiteConfig& config : suite.configs) {
      if (config.graph.name != file.stem()) continue;
      ++rows;
      const auto map = config.graph.vars.find("shadow_map");
      if (map != config.graph.vars.end()) maps.insert(std::get<std::int64_t>(map->second));
    }
    const bool has_map = load_graph(file).vars.count("shadow_map") != 0;
    EXPECT_EQ(rows, has_map ? 3u : 1u) << file;
    EXPECT_EQ(maps, has_map ? (std::set<std::int64_t>{512, 1024, 2048}) : std::set<std::int64_t>{}) << file;
  }
}

TEST_F(SuiteTest, ALimitOfTimeIsRead) {
  const std::string text =
      R"({ "scenes": ["a.glb"], "graphs": ["shadow_mapping"], "seconds": 1.5, "least": 3 })";
  const Suite suite = parse(text);
  EXPECT_EQ(suite.seconds, 1.5);
  EXPECT_EQ(suite.least, 3u);
}

TEST_F(SuiteTest, MissingFileIsNamed) {
  try {
    load_suite("no/such/suite.json");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no/such/suite.json"), std::string::npos);
  }
}

}  // namespace
}  // namespace gnomon
