// The targets by name, and how one is given an input.
#include "tests/fuzz/target.h"

#include <unistd.h>

#include <fstream>
#include <stdexcept>

#include "engine/base/error.h"

namespace gnomon::fuzz {

namespace fs = std::filesystem;

namespace {

// In memory where that is possible; of this process alone, and removed at its end.
class Folder {
 public:
  Folder()
      : path_((fs::is_directory("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path()) /
              ("gnomon-fuzz-" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> all = {
      {"scene", "input.glb", Kind::gltf, use_scene},  {"graph", "input.json", Kind::json, use_graph},
      {"suite", "input.json", Kind::json, use_suite}, {"rows", "results.jsonl", Kind::json_lines, use_rows},
      {"exr", "input.exr", Kind::bytes, use_mask},    {"png", "input.png", Kind::bytes, use_mask}};
  return all;
}

const Target& target(std::string_view name) {
  for (const Target& one : targets())
    if (one.name == name) return one;
  throw std::invalid_argument("no target " + std::string(name));
}

Outcome try_input(const Target& target, std::string_view bytes) {
  static const Folder folder;
  const fs::path file = folder.path() / target.file;
  std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
  try {
    target.use(file);
    return Outcome::taken;
  } catch (const Error&) {
    return Outcome::refused;
  }
}

}  // namespace gnomon::fuzz
