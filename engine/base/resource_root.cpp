// Where shaders, graphs, scenes and suites are found.
#include "engine/base/resource_root.h"

#include <cstdlib>

#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
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

}  // namespace gnomon
