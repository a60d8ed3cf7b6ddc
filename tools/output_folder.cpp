// A folder of results that appears whole or not at all.
#include "tools/output_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "engine/base/error.h"

namespace gnomon {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(const fs::path& folder) : folder_(fs::absolute(folder).lexically_normal()) {
  if (!folder_.has_filename()) folder_ = folder_.parent_path();
  staging_ = folder_ / fmt::format(".unfinished-{}", getpid());
  try {
    make(staging_);
  } catch (const fs::filesystem_error& error) {
    remove_made();
    fail("cannot make the folder: " + error.code().message(), folder_.string(), "--out");
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  if (!kept_) remove_made();
}

// One by one, to know which were made here and not by a process beside this one.
void OutputFolder::make(const fs::path& folder) {
  if (fs::is_directory(folder)) return;
  if (folder.has_relative_path()) make(folder.parent_path());
  if (fs::create_directory(folder)) made_.push_back(folder);
}

void OutputFolder::remove_made() {
  std::reverse(made_.begin(), made_.end());  // the innermost one first
  for (const fs::path& folder : made_) {
    std::error_code in_use;
    fs::remove(folder, in_use);
    if (in_use) return;
  }
}

fs::path OutputFolder::file(const std::string& name) {
  names_.push_back(name);
  return staging_ / name;
}

void OutputFolder::keep() {
  std::error_code error;
  for (const std::string& name : names_)
    if (fs::is_directory(folder_ / name, error))
      fail("cannot write: it is a folder", (folder_ / name).string());
  for (const std::string& name : names_) {
    fs::rename(staging_ / name, folder_ / name, error);
    if (error) fail("cannot write: " + error.message(), (folder_ / name).string());
  }
  kept_ = true;
}

std::string as_file_name(const std::string& name) {
  std::string safe = name;
  std::replace_if(
      safe.begin(), safe.end(),
      [](unsigned char c) { return c < 128 && !std::isalnum(c) && c != '-' && c != '_' && c != '.'; }, '_');
  constexpr size_t longest = 100;  // of the 255 bytes that file systems take
  safe.resize(std::min(safe.size(), longest));
  if (safe.empty() || safe.front() == '.') safe.insert(safe.begin(), '_');
  return safe;
}

}  // namespace gnomon
