// From a GLSL file to SPIR-V: includes, compilation, the disk cache.
#include "engine/vulkan/shader.h"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <glslang/build_info.h>
#define XXH_INLINE_ALL
#include <unistd.h>
#include <xxhash.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>
#include <sstream>

#include "engine/base/error.h"
#include "engine/base/input_file.h"
#include "engine/base/resource_root.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

constexpr int kCacheVersion = 3;  // raise when compile options change

fs::path shader_folder() { return resource_root() / "shaders" / "glsl"; }

// Path of an #include line, empty when the line is none.
std::string included_path(const std::string& line) {
  const size_t hash = line.find_first_not_of(" \t");
  if (hash == std::string::npos || line.compare(hash, 8, "#include") != 0) return {};
  const size_t open = line.find('"'), close = line.rfind('"');
  return open == close ? std::string() : line.substr(open + 1, close - open - 1);
}

fs::path resolve_include(const std::string& name, const fs::path& from, int line) {
  for (const fs::path& folder : {from.parent_path(), shader_folder()})
    if (fs::exists(folder / name)) return fs::canonical(folder / name);
  fail(fmt::format("no such include file '{}'", name), from.string(), fmt::format("line {}", line));
}

void expand(const fs::path& file, std::set<fs::path>& seen, std::string& out);

void expand_lines(std::istream& in, const fs::path& file, std::set<fs::path>& seen, std::string& out) {
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::string name = included_path(line);
    if (name.empty()) {
      out += line + '\n';
      continue;
    }
    expand(resolve_include(name, file, number), seen, out);
    out += fmt::format("#line {} \"{}\"\n", number + 1, file.string());
  }
}

void expand(const fs::path& file, std::set<fs::path>& seen, std::string& out) {
  if (!seen.insert(fs::weakly_canonical(file)).second) return;
  std::istringstream in(read_input_file(file));
  out += fmt::format("#line 1 \"{}\"\n", file.string());
  expand_lines(in, file, seen, out);
}

EShLanguage language(ShaderStage stage) {
  switch (stage) {
    case ShaderStage::vertex:
      return EShLangVertex;
    case ShaderStage::geometry:
      return EShLangGeometry;
    case ShaderStage::fragment:
      return EShLangFragment;
    case ShaderStage::compute:
      return EShLangCompute;
  }
  return EShLangCompute;
}

const char* stage_define(ShaderStage stage) {
  switch (stage) {
    case ShaderStage::vertex:
      return "VERTEX_SHADER";
    case ShaderStage::geometry:
      return "GEOMETRY_SHADER";
    case ShaderStage::fragment:
      return "FRAGMENT_SHADER";
    case ShaderStage::compute:
      return "COMPUTE_SHADER";
  }
  return "";
}

std::string full_text(const ShaderSource& source, const fs::path& file) {
  std::string text = "#version 460\n#extension GL_GOOGLE_cpp_style_line_directive : require\n";
  if (source.stage == ShaderStage::vertex) text += "#extension GL_ARB_shader_viewport_layer_array : enable\n";
  text += fmt::format("#define {} 1\n", stage_define(source.stage));
  for (const auto& [name, value] : source.defines) text += fmt::format("#define {} {}\n", name, value);
  text += "#line 1 \"generated preamble\"\n";
  std::set<fs::path> seen;
  std::istringstream preamble(source.preamble + "\n");
  expand_lines(preamble, shader_folder() / "generated preamble", seen, text);
  expand(file, seen, text);
  return text;
}

std::vector<uint32_t> to_spirv(const std::string& text, ShaderStage stage, const fs::path& file) {
  static std::once_flag once;  // glslang's own process-wide tables
  std::call_once(once, [] { glslang::InitializeProcess(); });
  glslang::TShader shader(language(stage));
  const char* strings[] = {text.c_str()};
  shader.setStrings(strings, 1);
  shader.setEnvInput(glslang::EShSourceGlsl, language(stage), glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_5);
  const auto messages = EShMessages(EShMsgSpvRules | EShMsgVulkanRules);
  if (!shader.parse(GetDefaultResources(), 460, false, messages))
    fail(fmt::format("the shader does not compile:\n{}", shader.getInfoLog()), file.string());
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(messages))
    fail(fmt::format("the shader does not link:\n{}", program.getInfoLog()), file.string());
  std::vector<uint32_t> words;
  glslang::SpvOptions options;
  options.disableOptimizer = true;  // drivers optimise; glslang's optimiser is absent from some builds
  glslang::GlslangToSpv(*program.getIntermediate(language(stage)), words, &options);
  return words;
}

// What a cache entry ends with: whose it is, and that it is whole. Drivers may crash on SPIR-V that a full
// disk cut short, and a file may have come under another one's name.
struct CacheSeal {
  uint64_t key_low, key_high;
  uint64_t checksum;
};

CacheSeal seal(const XXH128_hash_t& key, const std::vector<uint32_t>& words) {
  return {key.low64, key.high64, XXH3_64bits(words.data(), words.size() * sizeof(uint32_t))};
}

fs::path entry(const fs::path& cache, const XXH128_hash_t& key) {
  return cache / "spirv" / fmt::format("{:016x}{:016x}.spv", key.high64, key.low64);
}

// Empty when there is no such file, or not a whole one of this key.
std::vector<uint32_t> read_words(const fs::path& file, const XXH128_hash_t& key) {
  constexpr uint64_t most_bytes = uint64_t{64} << 20;  // hundreds of times the longest shader
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  const uint64_t size = fs::file_size(file, error);
  if (error || size <= sizeof(CacheSeal) || size > most_bytes || size % sizeof(uint32_t) != 0) return {};
  std::vector<uint32_t> words((size - sizeof(CacheSeal)) / sizeof(uint32_t));
  CacheSeal stored{};
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(words.data()), std::streamsize(words.size() * sizeof(uint32_t)));
  in.read(reinterpret_cast<char*>(&stored), sizeof(stored));
  const CacheSeal right = seal(key, words);
  if (!in || std::memcmp(&stored, &right, sizeof(right)) != 0) return {};
  return words;
}

// The cache only saves time: a folder that cannot be written is no error.
void write_words(const fs::path& file, const XXH128_hash_t& key, const std::vector<uint32_t>& words) {
  std::error_code ignored;
  fs::create_directories(file.parent_path(), ignored);
  const fs::path beside = file.string() + fmt::format(".{}", getpid());
  std::ofstream out(beside, std::ios::binary);
  const CacheSeal last = seal(key, words);
  out.write(reinterpret_cast<const char*>(words.data()), std::streamsize(words.size() * sizeof(uint32_t)));
  out.write(reinterpret_cast<const char*>(&last), sizeof(last));
  out.close();
  if (out)
    fs::rename(beside, file, ignored);
  else
    fs::remove(beside, ignored);
}

}  // namespace

std::string expand_includes(const fs::path& file) {
  std::set<fs::path> seen;
  std::string out;
  expand(file, seen, out);
  return out;
}

fs::path cache_folder() {
  if (const char* own = std::getenv("GNOMON_CACHE"); own && *own) return own;
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg) return fs::path(xdg) / "gnomon";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "gnomon";
  std::error_code error;
  const fs::path temporary = fs::temp_directory_path(error);
  return error ? fs::path() : temporary / "gnomon-cache";
}

std::vector<uint32_t> compile_shader(const ShaderSource& source) {
  const fs::path file = source.file.is_absolute() ? source.file : shader_folder() / source.file;
  const std::string text = full_text(source, file);
  const std::string key_text = fmt::format("{} {}.{}.{} {}\n", kCacheVersion, GLSLANG_VERSION_MAJOR,
                                           GLSLANG_VERSION_MINOR, GLSLANG_VERSION_PATCH, int(source.stage)) +
                               text;
  const XXH128_hash_t hash = XXH3_128bits(key_text.data(), key_text.size());
  const fs::path cache = cache_folder();
  if (cache.empty()) return to_spirv(text, source.stage, file);
  const fs::path cached = entry(cache, hash);
  if (auto words = read_words(cached, hash); !words.empty()) return words;
  auto words = to_spirv(text, source.stage, file);
  write_words(cached, hash, words);
  return words;
}

}  // namespace gnomon
