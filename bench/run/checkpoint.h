// The frames of techniques that are being measured in turn, on disk until their rows are: what lets a suite
// that was interrupted go on in the middle of its rounds.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "bench/run/rounds.h"

namespace gnomon {

// A file of JSON lines, one a frame. It survives the end of this process at any moment, not that of the
// machine: a disk that is flushed between frames would be measured with them.
class Checkpoint {
 public:
  // `go_on`: begin() finds what is there, less a torn last line; otherwise that is thrown away.
  Checkpoint(std::filesystem::path file, bool go_on);

  // The frames of `group` follow, techniques that are measured in turn with one another; frames of other
  // groups are thrown away. Error: disk full, ...
  void begin(const std::string& group);
  // Of the group's row with that key, as kept so far.
  Samples of(const std::string& key) const;
  // Error: disk full, ...
  void keep(const std::string& key, TimingMode mode, const FrameTiming& timing);
  // The group's rows are written: nothing is left to go on with.
  void end();

 private:
  std::filesystem::path file_;
  std::string group_;  // of frames_
  std::map<std::string, Samples> frames_;
  std::ofstream stream_;
};

}  // namespace gnomon
