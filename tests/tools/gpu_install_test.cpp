// Gnomon as it is installed: the program, programs that are built against it, and where they find their
// files.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "engine/image/image.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

struct Result {
  int status = -1;
  std::string output;
};

// Installed once for all tests, into a folder that is renamed afterwards: no place in it may be written down.
class Installed : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::path(testing::TempDir()) / ("gnomon_install_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    const Result r = run("'" GNOMON_TEST_CMAKE "' --install '" GNOMON_TEST_BINARY_DIR "' --prefix first");
    ASSERT_EQ(r.status, 0) << r.output;
    fs::rename(folder_ / "first", folder_ / "place");
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static Result run(const std::string& command) {
    const std::string whole =
        "cd '" + folder_.string() + "' && unset GNOMON_ROOT GNOMON_ASSETS && " + command + " > log.txt 2>&1";
    const int code = std::system(whole.c_str());
    return {WIFEXITED(code) ? WEXITSTATUS(code) : -1, text_of(folder_ / "log.txt")};
  }
  // Configures and builds the project in `source` against the installed package.
  static void build(const std::string& source) {
    const std::string cmake = "'" GNOMON_TEST_CMAKE "' ";
    const Result r = run(cmake + "-G Ninja -S " + source + " -B " + source +
                         "/build -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=\"$PWD/place\" && " + cmake +
                         "--build " + source + "/build --parallel 2");
    ASSERT_EQ(r.status, 0) << r.output;
  }
  // What reads the shaders of the source tree does not see that those of the package are gone.
  static void expect_shaders_of_package(const std::string& command) {
    const fs::path shaders = folder_ / "place" / "share" / "gnomon" / "shaders" / "glsl";
    fs::rename(shaders, folder_ / "hidden");
    const Result r = run(command);
    fs::rename(folder_ / "hidden", shaders);
    EXPECT_EQ(r.status, 2) << r.output;
    EXPECT_NE(r.output.find((folder_ / "place").string()), std::string::npos) << r.output;
  }

  static fs::path folder_;
};
fs::path Installed::folder_;

TEST_F(Installed, TheProgramFindsItsFilesBesideItself) {
  const std::string render =
      "place/bin/gnomon render square_plane --graph shadow_mapping --size 64x48 --device llvmpipe --out ";
  const Result r = run(render + "a");
  ASSERT_EQ(r.status, 0) << r.output;
  EXPECT_EQ(read_exr(folder_ / "a" / "visibility.exr").width, 64u);
  expect_shaders_of_package(render + "b");
  fs::copy(folder_ / "place/share/gnomon/assets/graphs/pcf.json",
           folder_ / "place/share/gnomon/assets/graphs/of_the_package.json");
  const Result other = run(
      "place/bin/gnomon render square_plane --graph of_the_package --size 64x48 --device llvmpipe --out c");
  EXPECT_EQ(other.status, 0) << other.output;
  const Result suite = run("place/bin/gnomon check place/share/gnomon/bench/suites/hard.json");
  EXPECT_EQ(suite.status, 0) << suite.output;
}

TEST_F(Installed, AnEnvironmentVariableNamesAnotherFolder) {
  fs::create_directories(folder_ / "other" / "assets" / "graphs");
  fs::copy(folder_ / "place/share/gnomon/assets/graphs/pcf.json", folder_ / "other/assets/graphs/pcf.json");
  const std::string there = run("GNOMON_ROOT=other place/bin/gnomon list graphs").output;
  EXPECT_NE(there.find("pcf"), std::string::npos) << there;
  EXPECT_EQ(there.find("shadow_volumes"), std::string::npos) << there;
  EXPECT_NE(run("place/bin/gnomon list graphs").output.find("shadow_volumes"), std::string::npos);
  EXPECT_EQ(run("GNOMON_ROOT=nowhere place/bin/gnomon list graphs").status, 2);
}

// The n-th fenced block of a language after a heading.
std::string block(const std::string& text, const std::string& heading, const std::string& language) {
  const std::string fence = "```" + language + "\n";
  const size_t at = text.find(heading);
  const size_t begin = text.find(fence, at) + fence.size();
  return text.substr(begin, text.find("```\n", begin) - begin);
}

TEST_F(Installed, TheReadmesLibraryExampleWorksToTheLetter) {
  const std::string readme = text_of(fs::path(GNOMON_TEST_SOURCE_DIR) / "README.md");
  fs::create_directories(folder_ / "library");
  write(folder_ / "library/CMakeLists.txt", block(readme, "## Using it as a library", "cmake"));
  write(folder_ / "library/main.cpp", block(readme, "## Using it as a library", "cpp"));
  build("library");
  if (HasFatalFailure()) return;
  fs::copy(folder_ / "place/share/gnomon/assets/scenes/square_plane.glb", folder_ / "library/scene.glb");
  const Result r = run("cd library && build/my_program");
  EXPECT_EQ(r.status, 0) << r.output;
  EXPECT_EQ(read_exr(folder_ / "library/visibility.exr").width, 1280u);
}

TEST_F(Installed, AnOwnTechniqueIsBuiltAgainstIt) {
  fs::copy(fs::path(GNOMON_TEST_SOURCE_DIR) / "examples" / "own_technique", folder_ / "own",
           fs::copy_options::recursive);
  build("own");
  if (HasFatalFailure()) return;
  const std::string program = "own/build/own_technique ", graph = "own/shadow_mapping_blurred.json";
  const std::string render = program + "render square_plane --graph " + graph +
                             " --size 64x48 --device llvmpipe --validation --out ";
  EXPECT_EQ(run(program + "check " + graph).status, 0);
  EXPECT_NE(run(program + "list passes").output.find("visibility_blur"), std::string::npos);
  const Result blurred = run(render + "blurred --set radius=4");
  ASSERT_EQ(blurred.status, 0) << blurred.output;
  const Result plain = run(render + "plain --set radius=0");
  ASSERT_EQ(plain.status, 0) << plain.output;
  size_t between = 0;
  for (const float v : read_exr(folder_ / "blurred/visibility.exr").data) between += v > 0 && v < 1;
  EXPECT_GT(between, 0u);
  for (const float v : read_exr(folder_ / "plain/visibility.exr").data) EXPECT_TRUE(v == 0 || v == 1) << v;
  expect_shaders_of_package(render + "c");
}

}  // namespace
}  // namespace gnomon
