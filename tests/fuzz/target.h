// What mutated inputs are given to: every reader of files that somebody else made.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::fuzz {

// How inputs are mutated besides byte by byte.
enum class Kind { bytes, json, json_lines, gltf };

struct Target {
  const char* name;  // of the program fuzz_NAME and of the folder corpus/NAME
  const char* file;  // inputs are read from a file of this name
  Kind kind;
  // Reads the file and does what commands do with it. Error: the input is refused, which is well. Anything
  // else that is thrown is a fault.
  void (*use)(const std::filesystem::path& file);
};

const std::vector<Target>& targets();
const Target& target(std::string_view name);

enum class Outcome { taken, refused };
// Writes the bytes to a file and uses it. Whatever but an Error is thrown goes on to the caller.
Outcome try_input(const Target& target, std::string_view bytes);

// Inputs that show what a target reads, by their names: all of them are taken.
std::map<std::string, std::string> seeds(const Target& target);

void use_scene(const std::filesystem::path& file);
void use_graph(const std::filesystem::path& file);
void use_suite(const std::filesystem::path& file);
void use_rows(const std::filesystem::path& file);
void use_mask(const std::filesystem::path& file);  // EXR or PNG

}  // namespace gnomon::fuzz
