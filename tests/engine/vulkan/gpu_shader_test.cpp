// From GLSL files to SPIR-V: includes, error places, the disk cache. No device is used.
#include "engine/vulkan/shader.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStore = R"(layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) buffer Values { float values[]; };
void main() { values[0] = VALUE; }
)";

// A folder with shaders and a cache of its own; the caller's GNOMON_CACHE is put back.
class ShaderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::path(::testing::TempDir()) / ("gnomon-shader-" + std::to_string(getpid()) + "-" + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    if (const char* old = std::getenv("GNOMON_CACHE")) old_cache_ = old;
    setenv("GNOMON_CACHE", (folder_ / "cache").c_str(), 1);
  }
  void TearDown() override {
    if (old_cache_.empty())
      unsetenv("GNOMON_CACHE");
    else
      setenv("GNOMON_CACHE", old_cache_.c_str(), 1);
    fs::remove_all(folder_);
  }

  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  static ShaderSource compute(const fs::path& file, Defines defines = {}) {
    return {file, ShaderStage::compute, {}, std::move(defines)};
  }
  std::vector<fs::path> cached() const {
    std::vector<fs::path> files;
    if (fs::exists(folder_ / "cache"))
      for (const auto& entry : fs::recursive_directory_iterator(folder_ / "cache"))
        if (entry.is_regular_file()) files.push_back(entry.path());
    return files;
  }
  static std::string error_of(const ShaderSource& source) {
    try {
      compile_shader(source);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }

  fs::path folder_;
  std::string old_cache_;
};

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

using GpuShader = ShaderTest;

TEST_F(GpuShader, compile_error_names_file_and_line) {
  const auto file =
      write("wrong.glsl", "layout(local_size_x = 1) in;\n\nvoid main() {\n  int i = no_such_name;\n}\n");
  const std::string error = error_of(compute(file));
  expect_contains(error, file.string() + ":4");
  expect_contains(error, "no_such_name");
}

TEST_F(GpuShader, compile_error_after_an_include_and_inside_one_keep_their_lines) {
  const auto part = write("lib/part.glsl", "float half_of(float x) { return 0.5 * x; }\n");
  const auto after =
      write("after.glsl",
            "layout(local_size_x = 1) in;\n#include \"lib/part.glsl\"\nvoid main() { wrong_here; }\n");
  expect_contains(error_of(compute(after)), after.string() + ":3");

  const auto bad = write("lib/bad.glsl", "// first line\n\nfloat f() { return wrong_inside; }\n");
  const auto user =
      write("user.glsl", "layout(local_size_x = 1) in;\n#include \"lib/bad.glsl\"\nvoid main() {}\n");
  const std::string error = error_of(compute(user));
  expect_contains(error, fs::canonical(bad).string() + ":3");
  expect_contains(error, "wrong_inside");
}

TEST_F(GpuShader, compile_error_in_the_preamble_is_told_from_the_file) {
  const auto file = write("fine.glsl", "layout(local_size_x = 1) in;\nvoid main() {}\n");
  ShaderSource source = compute(file);
  source.preamble = "float f() {\n  return wrong_in_preamble;\n}";
  expect_contains(error_of(source), "generated preamble:2");
}

TEST_F(GpuShader, missing_include_names_file_and_line) {
  const auto file = write("user.glsl", "// one\n// two\n#include \"no/such.glsl\"\nvoid main() {}\n");
  try {
    compile_shader(compute(file));
    FAIL() << "compiled without its include";
  } catch (const Error& error) {
    ASSERT_EQ(error.problems().size(), 1u);
    EXPECT_EQ(error.problems()[0].file, file.string());
    EXPECT_EQ(error.problems()[0].place, "line 3");
    expect_contains(error.problems()[0].what, "no/such.glsl");
  }
}

TEST_F(GpuShader, missing_file_is_an_error_that_names_it) {
  expect_contains(error_of(compute(folder_ / "absent.glsl")), (folder_ / "absent.glsl").string());
}

TEST_F(GpuShader, includes_resolve_beside_the_file_then_in_the_shader_folder_each_once) {
  write("near.glsl", "#include \"near2.glsl\"\n#include \"user.glsl\"\n");
  write("near2.glsl", "const float NEAR_TWO = 2.0;\n");
  const auto user = write(
      "user.glsl",
      "#include \"near.glsl\"\n#include \"near2.glsl\"\n#include \"lib/octahedral.glsl\"\nvoid main() {}\n");
  const std::string text = expand_includes(user);
  expect_contains(text, "octahedral_decode");
  const size_t first = text.find("NEAR_TWO");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(text.find("NEAR_TWO", first + 1), std::string::npos);
}

TEST_F(GpuShader, cache_gives_the_same_words) {
  const auto file = write("store.glsl", kStore);
  const auto first = compile_shader(compute(file, {{"VALUE", "1.5"}}));
  ASSERT_GT(first.size(), 5u);
  EXPECT_EQ(first[0], 0x07230203u);
  EXPECT_EQ(first[1], 0x00010500u) << "SPIR-V 1.5";
  ASSERT_EQ(cached().size(), 1u);
  const auto written = fs::last_write_time(cached()[0]);
  EXPECT_EQ(compile_shader(compute(file, {{"VALUE", "1.5"}})), first);
  EXPECT_EQ(cached().size(), 1u);
  EXPECT_EQ(fs::last_write_time(cached()[0]), written) << "a hit was compiled again";
}

TEST_F(GpuShader, cache_tells_defines_preambles_stages_and_included_text_apart) {
  const auto file = write("store.glsl", kStore);
  const auto one = compile_shader(compute(file, {{"VALUE", "1.0"}}));
  EXPECT_NE(compile_shader(compute(file, {{"VALUE", "2.0"}})), one);
  ShaderSource with_preamble = compute(file);
  with_preamble.preamble = "const float VALUE = 3.0;";
  EXPECT_NE(compile_shader(with_preamble), one);
  EXPECT_EQ(cached().size(), 3u);

  const auto user = write("user.glsl", "#include \"value.glsl\"\n" + std::string(kStore));
  write("value.glsl", "#define VALUE 4.0\n");
  const auto four = compile_shader(compute(user));
  write("value.glsl", "#define VALUE 5.0\n");
  EXPECT_NE(compile_shader(compute(user)), four) << "a change in an included file went unnoticed";
}

TEST_F(GpuShader, corrupted_cache_entry_is_compiled_again) {
  const auto file = write("store.glsl", kStore);
  const ShaderSource source = compute(file, {{"VALUE", "1.0"}});
  const auto words = compile_shader(source);
  ASSERT_EQ(cached().size(), 1u);
  const fs::path entry = cached()[0];
  const std::string whole = content(entry);
  std::string flipped = whole;
  flipped[whole.size() / 2] = char(flipped[whole.size() / 2] ^ 0x10);
  const std::pair<const char*, std::string> damages[] = {
      {"empty", ""},
      {"text", "this is no SPIR-V, and longer than its header"},
      {"cut short", whole.substr(0, whole.size() / 2 / 4 * 4)},
      {"cut within a word", whole.substr(0, whole.size() - 3)},
      {"one bit flipped", flipped}};
  for (const auto& [name, damage] : damages) {
    SCOPED_TRACE(name);
    std::ofstream(entry, std::ios::binary) << damage;
    EXPECT_EQ(compile_shader(source), words);
    EXPECT_EQ(content(entry), whole) << "the entry was not replaced";
  }
  EXPECT_EQ(cached().size(), 1u) << "something half-written stayed behind";
}

TEST_F(GpuShader, cache_that_cannot_be_written_is_no_error) {
  write("blocked", "a file where the folder should be");
  setenv("GNOMON_CACHE", (folder_ / "blocked").c_str(), 1);
  const auto file = write("store.glsl", kStore);
  EXPECT_GT(compile_shader(compute(file, {{"VALUE", "1.0"}})).size(), 5u);
}

TEST_F(GpuShader, failed_compilation_leaves_nothing_in_the_cache) {
  error_of(compute(write("wrong.glsl", "void main() { wrong; }\n")));
  EXPECT_TRUE(cached().empty());
}

}  // namespace
}  // namespace gnomon
