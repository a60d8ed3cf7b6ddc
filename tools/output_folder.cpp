// A folder of results that appears whole or not at all.
#include "tools/output_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

fs::path topmost_missing(const fs::path& folder) {
  fs::path missing;
  for (fs::path path = folder; !path.empty() && !fs::exists(path); path = path.parent_path()) {
    missing = path;
    if (path == path.parent_path()) break;
  }
  return missing;
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder) : folder_(fs::absolute(folder).lexically_normal()) {
  if (!folder_.has_filename()) folder_ = folder_.parent_path();
  staging_ = folder_ / fmt::format(".unfinished-{}", getpid());
  made_ = topmost_missing(folder_);
  std::error_code error;
  fs::create_directories(staging_, error);
  if (error) {
    const std::string reason = error.message();
    if (!made_.empty()) fs::remove_all(made_, error);
    fail("cannot make the folder: " + reason, folder_.string(), "--out");
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  if (!kept_ && !made_.empty()) fs::remove_all(made_, ignored);
}

fs::path OutputFolder::file(const std::string& name) {
  names_.push_back(name);
  return staging_ / name;
}

void OutputFolder::keep() {
  for (const std::string& name : names_) {
    std::error_code error;
    fs::rename(staging_ / name, folder_ / name, error);
    if (error) fail("cannot write: " + error.message(), (folder_ / name).string());
  }
  kept_ = true;
}

}  // namespace gnomon
