// Where graph files, shaders and scenes are found.
#include <algorithm>
#include <cstdlib>
#include <set>

#include "engine/error.h"
#include "engine/graph.h"
#include "engine/json_text.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error) && !fs::is_directory(path, error);
}

// Folders of graph files, the first one that has a name wins.
std::vector<fs::path> graph_folders() {
  std::vector<fs::path> folders;
  const char* assets = std::getenv("GNOMON_ASSETS");
  if (assets && *assets) folders.push_back(fs::path(assets) / "graphs");
  folders.push_back(resource_root() / "assets" / "graphs");
  return folders;
}

}  // namespace

fs::path resource_root() {
  const char* root = std::getenv("GNOMON_ROOT");
  if (root && *root) {
    if (!is_folder(root)) fail("is not a folder", root, "GNOMON_ROOT");
    return root;
  }
  if (is_folder(GNOMON_SOURCE_DIR)) return GNOMON_SOURCE_DIR;
  if (is_folder(GNOMON_INSTALL_DIR)) return GNOMON_INSTALL_DIR;
  fail("the folder with assets/ and shaders/ is missing", GNOMON_INSTALL_DIR, {}, "set GNOMON_ROOT to it");
}

std::vector<fs::path> all_graphs() {
  std::vector<fs::path> result;
  std::set<std::string> names;
  for (const fs::path& folder : graph_folders()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (entry.path().extension() == ".json" && is_file(entry.path()) &&
          names.insert(entry.path().stem()).second)
        result.push_back(entry.path());
  }
  std::sort(result.begin(), result.end(),
            [](const fs::path& a, const fs::path& b) { return a.stem() < b.stem(); });
  return result;
}

fs::path find_graph(const std::string& name_or_file) {
  const bool a_path = name_or_file.ends_with(".json") || name_or_file.find('/') != std::string::npos;
  if (a_path) {
    if (!is_file(name_or_file)) fail("no such graph file", name_or_file);
    return name_or_file;
  }
  std::vector<std::string> names;
  for (const fs::path& path : all_graphs()) {
    names.push_back(path.stem());
    if (names.back() == name_or_file) return path;
  }
  fail("unknown graph " + in_quotes(name_or_file), {}, {}, did_you_mean(name_or_file, names));
}

}  // namespace gnomon
