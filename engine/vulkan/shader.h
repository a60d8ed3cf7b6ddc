// GLSL files to SPIR-V at run time: includes, defines, a disk cache, errors that name file and line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

enum class ShaderStage { vertex, geometry, fragment, compute };

using Defines = std::vector<std::pair<std::string, std::string>>;

struct ShaderSource {
  std::filesystem::path file;  // below shaders/glsl, or absolute
  ShaderStage stage = ShaderStage::compute;
  std::string preamble;  // generated text put before the file: bindings, parameter block
  Defines defines;
};

// The file with its `#include "path"` lines replaced by the files they name (relative to the including file,
// then to shaders/glsl), each at most once, with #line directives. Error: file and line of a missing include.
std::string expand_includes(const std::filesystem::path& file);

// SPIR-V 1.5 words. Read from the cache when the same expanded text was compiled before by the same glslang.
// Error: what glslang says, with file and line.
std::vector<uint32_t> compile_shader(const ShaderSource& source);

// Folder of the caches (GNOMON_CACHE, else $XDG_CACHE_HOME/gnomon, else ~/.cache/gnomon, else below the
// folder for temporary files). Empty: there is no place for one, and nothing is kept.
std::filesystem::path cache_folder();

}  // namespace gnomon
