// A folder of results belongs to one process at a time.
#pragma once

#include <filesystem>

namespace gnomon {

// Holds the file "in-use" in the folder, which it makes when missing. The file names its owner; one that a
// process left behind when it died is taken over, since the lock on it ended with the process. Error: another
// process holds it.
class OutputLock {
 public:
  explicit OutputLock(const std::filesystem::path& folder);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  void take();
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace gnomon
