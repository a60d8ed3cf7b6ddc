// Where shaders, graphs, scenes and suites are found.
#include "engine/base/resource_root.h"

#include <dlfcn.h>

#include <cstdlib>
#include <vector>

#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

bool has_resources(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder / "assets", error) && fs::is_directory(folder / "shaders", error);
}

fs::path& offered() {
  static fs::path folder;
  return folder;
}

// Files that this code is part of: the program, or a shared library.
std::vector<fs::path> own_files() {
  std::error_code error;
  std::vector<fs::path> files;
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&resource_root), &info) != 0 && info.dli_fname)
    files.push_back(fs::canonical(info.dli_fname, error));
  files.push_back(fs::read_symlink("/proc/self/exe", error));
  return files;
}

// PREFIX/share/gnomon of a file at PREFIX/bin, PREFIX/lib or PREFIX/lib/ARCHITECTURE; empty when there is
// none.
fs::path beside(const fs::path& file) {
  fs::path folder = file.parent_path();
  for (int up = 0; up < 3 && !folder.empty(); ++up, folder = folder.parent_path())
    if (has_resources(folder / "share" / "gnomon")) return folder / "share" / "gnomon";
  return {};
}

}  // namespace

fs::path resource_root() {
  const char* root = std::getenv("GNOMON_ROOT");
  if (root && *root) {
    std::error_code error;
    if (!fs::is_directory(root, error)) fail("is not a folder", root, "GNOMON_ROOT");
    return root;
  }
  for (const fs::path& file : own_files())
    if (fs::path found = beside(file); !found.empty()) return found;
  for (const fs::path& folder : {offered(), fs::path(GNOMON_SOURCE_DIR)})
    if (!folder.empty() && has_resources(folder)) return folder;
  fail("the folder with assets/ and shaders/ is not beside the program", {}, {}, "set GNOMON_ROOT to it");
}

bool offer_resource_root(const char* folder) {
  offered() = folder;
  return true;
}

}  // namespace gnomon
