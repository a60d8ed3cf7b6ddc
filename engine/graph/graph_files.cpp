// Where graph files are found.
#include <algorithm>
#include <cstdlib>
#include <set>

#include "engine/base/error.h"
#include "engine/base/json_text.h"
#include "engine/base/resource_root.h"
#include "engine/graph/graph.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

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
