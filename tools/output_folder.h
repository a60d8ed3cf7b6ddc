// A folder of results that appears whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

// Files are written into a hidden folder beside their place; keep() moves them there. Without keep() nothing
// of them remains, nor do folders that were made for them and are empty: what others wrote there meanwhile
// stays. Error when the folder cannot be made or written.
class OutputFolder {
 public:
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  std::filesystem::path file(const std::string& name);  // where to write `name` until keep()
  void keep();

 private:
  void make(const std::filesystem::path& folder);
  void remove_made();

  std::filesystem::path folder_, staging_;
  std::vector<std::filesystem::path> made_;  // folders that were not there, from the topmost one
  std::vector<std::string> names_;
  bool kept_ = false;
};

// A name out of a file as a part of a path: one folder or file, not hidden, 1 to 101 bytes; what is no
// letter, digit, '-', '_' or '.' becomes '_'.
std::string as_file_name(const std::string& name);

}  // namespace gnomon
