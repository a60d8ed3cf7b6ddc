// A folder of results that appears whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

// Files are written into a hidden folder beside their place; keep() moves them there. Without keep() nothing
// remains, nor does the folder when it was not there before. Error when the folder cannot be made or written.
class OutputFolder {
 public:
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  std::filesystem::path file(const std::string& name);  // where to write `name` until keep()
  void keep();

 private:
  std::filesystem::path folder_, staging_;
  std::filesystem::path made_;  // topmost folder that was not there; empty: none
  std::vector<std::string> names_;
  bool kept_ = false;
};

}  // namespace gnomon
