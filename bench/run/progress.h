// How far long work is: a bar on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

namespace gnomon {

// Writes to `stream` (standard error, so that results can be piped). On a terminal one line that is redrawn;
// elsewhere a line at most every `quiet_seconds`, and one at the end.
class Progress {
 public:
  explicit Progress(std::string what, double quiet_seconds = 5, std::FILE* stream = stderr);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(double fraction, const std::string& note = {});  // fraction: 0..1, clamped
  void say(const std::string& line);                           // a line of its own, above the bar
  void done(const std::string& note = {});                     // the last line; later calls do nothing

 private:
  using Clock = std::chrono::steady_clock;
  void draw(const std::string& note);
  std::string text(const std::string& note) const;

  std::string what_;
  std::FILE* stream_;
  bool terminal_;
  bool done_ = false;
  bool drawn_ = false;
  double fraction_ = 0;
  double quiet_seconds_;
  Clock::time_point start_, last_;
};

}  // namespace gnomon
