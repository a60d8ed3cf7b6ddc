// The program as a user meets it: bad input gives a message that names the place, exit status 2, and no
// files.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/image/image.h"
#include "tools/cli.h"
#include "tools/output_folder.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int status = -1;  // exit status; -1: it did not exit by itself
  std::string out, error;
};

std::string read_text(const fs::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

class CliTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("cli_test_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    for (const auto& [name, text] : files()) std::ofstream(folder_ / name) << text;
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Runs `gnomon arguments` in the test's folder.
  Outcome run(const std::string& arguments) const {
    const fs::path out = folder_.string() + ".out", error = folder_.string() + ".err";
    const std::string command = "cd '" + folder_.string() + "' && '" GNOMON_EXECUTABLE "' " + arguments +
                                " >'" + out.string() + "' 2>'" + error.string() + "'";
    const int code = std::system(command.c_str());
    Outcome outcome{WIFEXITED(code) ? WEXITSTATUS(code) : -1, read_text(out), read_text(error)};
    fs::remove(out);
    fs::remove(error);
    return outcome;
  }

  static std::vector<std::pair<std::string, std::string>> files() {
    return {
        {"empty.json", ""},
        {"torn.json", "{ \"schema\": 1, \"name\": \"x\""},
        {"neither.json", "{ \"schema\": 1 }"},
        {"unknown_pass.json",
         R"({"schema":1,"name":"x","passes":[{"id":"a","type":"gbufer"}],"outputs":{"visibility":"a.depth"}})"},
        {"unknown_port.json",
         R"({"schema":1,"name":"x","passes":[{"id":"a","type":"gbuffer"}],"outputs":{"visibility":"a.dpth"}})"},
        {"duplicate.json", R"({"schema":1,"schema":1,"name":"x","passes":[],"outputs":{}})"},
        {"not_a_scene.glb", "this is no glTF"},
        {"text.exr", "this is no EXR"},
        {"suite.json", R"({"scenes":["absent.glb"],"graphs":["shadow_mapping"]})"}};
  }
  size_t entries() const {
    size_t count = 0;
    for ([[maybe_unused]] const auto& entry : fs::recursive_directory_iterator(folder_)) ++count;
    return count;
  }
  fs::path folder_;
};

struct BadInput {
  const char* arguments;
  std::vector<std::string> pieces;  // of the message
};

const std::vector<BadInput>& bad_inputs() {
  static const std::vector<BadInput> table = {
      {"", {"subcommand"}},
      {"rendr fence", {"rendr"}},
      {"render", {"SCENE"}},
      {"render fence", {"--graph"}},
      {"render absent.glb --graph shadow_mapping --out out", {"absent.glb", "no such scene"}},
      {"render not_a_scene.glb --graph shadow_mapping --out out", {"not_a_scene.glb"}},
      {"render fence --graph shadow_maping --out out", {"shadow_maping", "shadow_mapping"}},
      {"render fence --graph absent.json --out out", {"absent.json"}},
      {"render fence --graph empty.json --out out", {"empty.json"}},
      {"render fence --graph torn.json --out out", {"torn.json", "line 1"}},
      {"render fence --graph unknown_pass.json --out out",
       {"unknown_pass.json", "gbufer", "gbuffer", "/passes/0"}},
      {"render fence --graph unknown_port.json --out out",
       {"unknown_port.json", "dpth", "/outputs/visibility"}},
      {"render fence --graph duplicate.json --out out", {"duplicate.json", "schema"}},
      {"render fence --graph shadow_mapping --size 0x0 --out out", {"0x0", "--size"}},
      {"render fence --graph shadow_mapping --size 1280 --out out", {"1280", "WIDTHxHEIGHT"}},
      {"render fence --graph shadow_mapping --size 1280x --out out", {"1280x"}},
      {"render fence --graph shadow_mapping --size 64x-36 --out out", {"64x-36"}},
      {"render fence --graph shadow_mapping --size 99999x1 --out out", {"99999x1", "16384"}},
      {"render fence --graph shadow_mapping --size 99999999999x1 --out out", {"99999999999x1"}},
      {"render fence --graph shadow_mapping --set shadow_mop=512 --out out", {"shadow_mop", "shadow_map"}},
      {"render fence --graph shadow_mapping --set shadow_map=0 --out out", {"shadow_mapping.json", "0"}},
      {"render fence --graph shadow_mapping --set shadow_map=much --out out", {"shadow_mapping.json"}},
      {"render fence --graph shadow_mapping --set bias=magic --out out", {"magic"}},
      {"render fence --graph shadow_mapping --set shadow_map --out out", {"NAME=VALUE"}},
      {"render fence --graph shadow_mapping --set depth=linear --set depth=linear --out out", {"twice"}},
      {"render fence --graph shadow_mapping --camera 99 --out out", {"camera 99"}},
      {"render fence --graph shadow_mapping --camera-z sideways --out out", {"sideways", "reversed"}},
      {"render fence --graph shadow_mapping --repeat 0 --out out", {"--repeat"}},
      {"render fence --graph shadow_mapping --capture map.depth --out out", {"--capture", "map.depth"}},
      {"render fence --graph shadow_mapping --capture map.depth=map.png --out out", {"map.png"}},
      {"render fence --graph shadow_mapping --reference many --out out", {"many"}},
      {"render fence --graph shadow_mapping --device no-such-device --out out", {"no-such-device"}},
      {"render fence --graph shadow_mapping --frobnicate --out out", {"--frobnicate"}},
      {"reference absent.glb --out x.exr", {"absent.glb"}},
      {"reference fence --out x.png", {"x.png", ".exr"}},
      {"reference fence", {"--out"}},
      {"reference fence --size 0x5 --out x.exr", {"0x5"}},
      {"compare a.exr b.exr", {"a.exr"}},
      {"compare text.exr text.exr", {"text.exr"}},
      {"compare a.exr", {"REFERENCE"}},
      {"bench absent.json", {"absent.json"}},
      {"bench suite.json --out out", {"suite.json", "absent.glb", "/scenes/0"}},
      {"bench torn.json --out out", {"torn.json"}},
      {"bench demo --shard 3/2 --out out", {"3/2"}},
      {"bench demo --shard 1 --out out", {"--shard"}},
      {"bench demo --scene nowhere --out out", {"no such scene file", "nowhere"}},
      {"bench demo --resume --overwrite --out out", {"--overwrite"}},
      {"explain absent.glb --graph shadow_mapping", {"absent.glb"}},
      {"explain fence --graph shadow_mapping --size nothing", {"nothing"}},
      {"check absent.json", {"absent.json", "no such file"}},
      {"check neither.json", {"neither.json"}},
      {"check empty.json torn.json unknown_pass.json", {"empty.json", "torn.json", "unknown_pass.json"}},
      {"check not_a_scene.glb", {"not_a_scene.glb"}},
      {"check .", {"folder"}},
      {"list", {"subcommand"}},
      {"list wishes", {"wishes"}},
      {"scene generate castle --out out", {"castle"}},
      {"scene info absent.glb", {"absent.glb"}},
  };
  return table;
}

TEST_F(CliTest, BadInputIsStatusTwoWithAMessageAndNoFiles) {
  const size_t before = entries();
  for (const BadInput& bad : bad_inputs()) {
    const Outcome outcome = run(bad.arguments);
    EXPECT_EQ(outcome.status, 2) << bad.arguments << "\n" << outcome.error;
    EXPECT_TRUE(outcome.error.starts_with("gnomon: ")) << bad.arguments << "\n" << outcome.error;
    for (const std::string& piece : bad.pieces)
      EXPECT_NE(outcome.error.find(piece), std::string::npos)
          << bad.arguments << ": no '" << piece << "' in\n"
          << outcome.error;
    EXPECT_EQ(entries(), before) << bad.arguments;
  }
}

TEST_F(CliTest, NoVulkanDeviceIsStatusTwo) {
  std::vector<std::pair<const char*, std::string>> before;
  for (const char* name : {"VK_ICD_FILENAMES", "VK_DRIVER_FILES"}) {
    const char* value = std::getenv(name);
    before.emplace_back(name, value != nullptr ? value : "");
    setenv(name, "/nonexistent.json", 1);
  }
  const Outcome without = run("render fence --graph shadow_mapping --size 64x36 --out out2");
  for (const auto& [name, value] : before) value.empty() ? unsetenv(name) : setenv(name, value.c_str(), 1);
  EXPECT_EQ(without.status, 2);
  EXPECT_NE(without.error.find("Vulkan"), std::string::npos) << without.error;
  EXPECT_FALSE(fs::exists(folder_ / "out2"));
}

TEST_F(CliTest, HelpTeaches) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.status, 0);
  for (const char* piece : {"render", "reference", "compare", "bench", "check", "list", "explain", "scene",
                            "Examples", "Exit status"})
    EXPECT_NE(help.out.find(piece), std::string::npos) << piece;
  for (const char* command : {"render", "reference", "compare", "bench", "explain", "check"}) {
    const Outcome one = run(std::string(command) + " --help");
    EXPECT_EQ(one.status, 0) << command;
    EXPECT_NE(one.out.find("Example"), std::string::npos) << command;
  }
  EXPECT_NE(run("render --help").out.find("1280x720"), std::string::npos);  // defaults are shown
  EXPECT_EQ(run("--version").out.rfind("gnomon ", 0), 0u);
}

TEST_F(CliTest, ListsNeedNoDevice) {
  const Outcome passes = run("list passes");
  EXPECT_EQ(passes.status, 0) << passes.error;
  EXPECT_NE(passes.out.find("gbuffer"), std::string::npos);
  EXPECT_NE(passes.out.find("is asked for encoding, bias"), std::string::npos);
  EXPECT_NE(run("list graphs").out.find("shadow_mapping"), std::string::npos);
  EXPECT_NE(run("list scenes").out.find("fence"), std::string::npos);
  EXPECT_NE(run("list metrics").out.find("misclassified"), std::string::npos);
  EXPECT_NE(run("list schema").out.find("$schema"), std::string::npos);
}

TEST_F(CliTest, CheckTellsFilesByTheirContent) {
  const std::string root = GNOMON_TEST_SOURCE_DIR;
  const Outcome outcome = run("check " + root + "/assets/graphs/*.json " + root + "/bench/suites/*.json " +
                              root + "/assets/scenes/fence.glb");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  for (const char* piece : {"ok (graph", "ok (suite", "ok (scene"})
    EXPECT_NE(outcome.out.find(piece), std::string::npos) << piece;
}

Image visibility_image(uint32_t width, uint32_t height, float value) {
  Image image(width, height, {"Y"});
  for (float& x : image.data) x = value;
  return image;
}

TEST_F(CliTest, AFolderOfTheSameNameDoesNotHideASceneOrSuite) {
  fs::create_directories(folder_ / "fence");
  fs::create_directories(folder_ / "demo");
  EXPECT_EQ(run("scene info fence").status, 0);
  const Outcome outcome = run("bench demo --shard 0/1");
  EXPECT_EQ(outcome.error.find("folder"), std::string::npos) << outcome.error;
}

TEST_F(CliTest, FileSizeLimitIsStatusTwoAndLeavesNothing) {
  const Outcome outcome = run("scene info fence >/dev/null; ulimit -f 8; '" GNOMON_EXECUTABLE
                              "' reference fence --size 64x36 --out x.exr");
  EXPECT_EQ(outcome.status, 2) << outcome.error;
  EXPECT_FALSE(fs::exists(folder_ / "x.exr"));
}

TEST_F(CliTest, CompareGivesTheFigures) {
  Image result = visibility_image(4, 2, 1), reference = visibility_image(4, 2, 1);
  reference.at(0, 0) = 0;  // one of eight pixels is wrongly lit
  write_exr(folder_ / "result.exr", result);
  write_exr(folder_ / "reference.exr", reference);
  const Outcome outcome = run("compare result.exr reference.exr");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_NE(outcome.out.find("0.125"), std::string::npos) << outcome.out;
  EXPECT_EQ(run("compare result.exr reference.exr --max-misclassified 0.1").status, 1);
  EXPECT_EQ(run("compare result.exr reference.exr --max-misclassified 0.2").status, 0);
  EXPECT_EQ(run("compare result.exr reference.exr --json").out.rfind("{", 0), 0u);
  EXPECT_EQ(run("compare result.exr reference.exr --json figures.json").status, 0);
  EXPECT_NE(read_text(folder_ / "figures.json").find("\"misclassified\": 0.125"), std::string::npos);
}

TEST_F(CliTest, CompareHasOneShapeForOneAndSeveralLights) {
  Image two(4, 2, {"Y", "light1.Y"});
  write_exr(folder_ / "one.exr", visibility_image(4, 2, 1));
  write_exr(folder_ / "two.exr", two);
  const auto figures = [&](const std::string& file) {
    return nlohmann::json::parse(run("compare " + file + " " + file + " --json").out);
  };
  const auto one = figures("one.exr"), other = figures("two.exr");
  EXPECT_EQ(one["lights"].size(), 1u);
  EXPECT_EQ(other["lights"].size(), 2u);
  EXPECT_EQ(one["rmse"], 0.0);
  EXPECT_EQ(other["lights"][1]["rmse"], 0.0);
}

TEST_F(CliTest, CompareWithoutCountedPixelsSaysWhy) {
  Image reference(4, 2, {"Y", "domain"});
  for (float& x : reference.plane(1)) x = 2;  // all face away
  write_exr(folder_ / "result.exr", visibility_image(4, 2, 1));
  write_exr(folder_ / "reference.exr", reference);
  const Outcome outcome = run("compare result.exr reference.exr --max-misclassified 0 --max-rmse 0");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_NE(outcome.out.find("no pixel counts: 8 face away from the light"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("misclassified     -\n"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("nan"), std::string::npos) << outcome.out;
}

TEST_F(CliTest, CheckGoesOnWhateverAFileDoes) {
  std::ofstream(folder_ / "odd.gltf") << R"({"asset": 3, "scenes": "none", "nodes": {"a": null}})";
  fs::copy_file(fs::path(GNOMON_TEST_SOURCE_DIR) / "assets" / "graphs" / "pcf.json", folder_ / "good.json");
  const Outcome outcome = run("check odd.gltf torn.json good.json");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.error.find("odd.gltf"), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.out.find("good.json: ok"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.error.find("json.exception"), std::string::npos) << outcome.error;
}

TEST_F(CliTest, NamesCannotSteerTheTerminal) {
  std::ofstream(folder_ / "odd.json")
      << R"({"schema":1,"name":"x","passes":[{"id":"a\u001b[31m","type":"gb\nuffer\u001b]0;t\u0007"}],"outputs":{}})";
  const Outcome outcome = run("check odd.json 'no\033[2J.json'");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.error.find('\x1b'), std::string::npos) << outcome.error;
  EXPECT_EQ(outcome.error.find('\x07'), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find("\\x1b"), std::string::npos) << outcome.error;
}

TEST_F(CliTest, CompareRefusesWhatDoesNotMatch) {
  write_exr(folder_ / "small.exr", visibility_image(4, 2, 1));
  write_exr(folder_ / "large.exr", visibility_image(8, 2, 1));
  Image other(4, 2, {"Q"});
  write_exr(folder_ / "other.exr", other);
  const Outcome size = run("compare small.exr large.exr");
  EXPECT_EQ(size.status, 2);
  EXPECT_NE(size.error.find("4x2"), std::string::npos) << size.error;
  EXPECT_EQ(run("compare other.exr small.exr").status, 2);
  EXPECT_EQ(run("compare small.exr other.exr").status, 2);
}

// Images of other programs have other channels.
TEST_F(CliTest, CompareTakesAnotherChannelByName) {
  Image truth(2, 1, {"Y"}), colors(2, 1, {"R", "G", "B"}), layer(2, 1, {"shadow.Y"});
  truth.data = {0, 1};
  colors.data = {0, 1, 0, 1, 0, 1};
  layer.data = {0, 1};
  write_exr(folder_ / "truth.exr", truth);
  write_exr(folder_ / "colors.exr", colors);
  write_exr(folder_ / "layer.exr", layer);
  const Outcome without = run("compare colors.exr truth.exr");
  EXPECT_EQ(without.status, 2);
  EXPECT_NE(without.error.find("no channel 'Y'; it has: B, G, R"), std::string::npos) << without.error;
  EXPECT_NE(without.error.find("--channel"), std::string::npos);
  EXPECT_EQ(run("compare colors.exr truth.exr --channel luminance --max-rmse 0.001").status, 0);
  EXPECT_EQ(run("compare layer.exr truth.exr --channel shadow --max-rmse 0").status, 0);
  EXPECT_EQ(run("compare layer.exr layer.exr --channel shadow.Y --max-rmse 0").status, 0);
  EXPECT_EQ(run("compare layer.exr truth.exr --channel sun").status, 2);
}

TEST_F(CliTest, SceneExportIsReadBack) {
  EXPECT_EQ(run("scene export fence --out fence.glb").status, 0);
  const Outcome checked = run("check fence.glb");
  EXPECT_EQ(checked.status, 0) << checked.error;
  EXPECT_EQ(run("scene export fence --out fence.gltf").status, 2);
  EXPECT_EQ(run("scene export absent --out fence2.glb").status, 2);
}

TEST_F(CliTest, CompareFailsOnValuesThatAreNotFinite) {
  Image result = visibility_image(4, 2, 1);
  result.at(1, 1) = NAN;
  write_exr(folder_ / "result.exr", result);
  write_exr(folder_ / "reference.exr", visibility_image(4, 2, 1));
  EXPECT_EQ(run("compare result.exr reference.exr").status, 1);
}

TEST_F(CliTest, ReferenceWritesWhatCompareReads) {
  const Outcome outcome = run("reference fence --size 32x18 --out made/fence.exr");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(run("compare made/fence.exr made/fence.exr --max-misclassified 0").status, 0);
}

TEST_F(CliTest, FullDiskIsStatusTwo) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  EXPECT_EQ(run("reference fence --size 32x18 --out /dev/full/x.exr").status, 2);
  EXPECT_EQ(run("reference fence --size 32x18 --out /proc/x.exr").status, 2);
}

TEST(OutputFolder, AppearsWholeOrNotAtAll) {
  const fs::path base = fs::path(testing::TempDir()) / "output_folder_test";
  fs::remove_all(base);
  {
    OutputFolder folder(base / "a" / "b");
    write_text(folder.file("x.txt"), "x");
    EXPECT_FALSE(fs::exists(base / "a" / "b" / "x.txt"));
  }
  EXPECT_FALSE(fs::exists(base));
  {
    OutputFolder folder(base / "a" / "b");
    write_text(folder.file("x.txt"), "x");
    folder.keep();
  }
  EXPECT_EQ(read_text(base / "a" / "b" / "x.txt"), "x");
  {
    OutputFolder folder(base / "a" / "b");  // what was there stays when nothing is kept
    write_text(folder.file("x.txt"), "y");
  }
  EXPECT_EQ(read_text(base / "a" / "b" / "x.txt"), "x");
  EXPECT_EQ(std::distance(fs::directory_iterator(base / "a" / "b"), fs::directory_iterator()), 1);
  fs::remove_all(base);
}

TEST(ParseSize, AcceptsSidesInRange) {
  EXPECT_EQ(parse_size("1x16384"), (Extent{1, 16384}));
  for (const char* bad : {"", "x", "1x", "x1", "0x1", "1x0", "1x16385", "1X2", "1x2x3", " 1x2", "1x2 ",
                          "-1x2", "1.5x2", "4294967297x1"})
    EXPECT_THROW(parse_size(bad), Error) << bad;
}

TEST(ParseSet, ReadsTypedValues) {
  const Values values = parse_set({"a=1", "b=0.5", "c=true", "d=linear", "e=x=y"});
  EXPECT_EQ(values.at("a"), Value(std::int64_t(1)));
  EXPECT_EQ(values.at("b"), Value(0.5));
  EXPECT_EQ(values.at("c"), Value(true));
  EXPECT_EQ(values.at("d"), Value(std::string("linear")));
  EXPECT_EQ(values.at("e"), Value(std::string("x=y")));
  for (const char* bad : {"", "=", "=1", "a=", "a"}) EXPECT_THROW(parse_set({bad}), Error) << bad;
  EXPECT_THROW(parse_set({"a=1", "a=2"}), Error);
}

}  // namespace
}  // namespace gnomon
