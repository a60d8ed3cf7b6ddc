// Shows how far long work is: a bar on a terminal, plain lines elsewhere.
#include "bench/run/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "engine/base/printable.h"

namespace gnomon {
namespace {

constexpr double kRedrawSeconds = 0.1;

size_t terminal_width(std::FILE* stream) {
  winsize size{};
  if (ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 20) return size.ws_col;
  return 80;
}

std::string duration(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

Progress::Progress(std::string what, double quiet_seconds, std::FILE* stream)
    : what_(std::move(what)),
      stream_(stream),
      terminal_(isatty(fileno(stream)) == 1),
      quiet_seconds_(quiet_seconds),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (terminal_ && drawn_ && !done_) std::fputc('\n', stream_);
}

std::string Progress::text(const std::string& note) const {
  const double elapsed = seconds_between(start_, Clock::now());
  std::string left;
  if (fraction_ > 0.02 && fraction_ < 1)
    left = ", " + duration(elapsed * (1 - fraction_) / fraction_) + " left";
  return fmt::format("{:3.0f} %  {}{}{}{}", 100 * fraction_, duration(elapsed), left,
                     note.empty() ? "" : "  ", note);
}

void Progress::draw(const std::string& note) {
  if (!terminal_) {
    fmt::print(stream_, "{}\n", printable(what_ + ": " + text(note)));
    std::fflush(stream_);
    return;
  }
  constexpr size_t cells = 24;
  const auto full = static_cast<size_t>(fraction_ * cells);
  std::string line =
      fmt::format("{} [{}{}] {}", what_, std::string(full, '#'), std::string(cells - full, '.'), text(note));
  line = printable(line);
  line.resize(std::min(line.size(), terminal_width(stream_) - 1));
  fmt::print(stream_, "\r\x1b[K{}", line);
  std::fflush(stream_);
  drawn_ = true;
}

void Progress::update(double fraction, const std::string& note) {
  if (done_) return;
  fraction_ = std::clamp(fraction, 0.0, 1.0);
  const auto now = Clock::now();
  if (seconds_between(last_, now) < (terminal_ ? kRedrawSeconds : quiet_seconds_)) return;
  last_ = now;
  draw(note);
}

void Progress::say(const std::string& line) {
  if (terminal_ && drawn_) fmt::print(stream_, "\r\x1b[K");
  fmt::print(stream_, "{}\n", printable(line));
  std::fflush(stream_);
}

void Progress::done(const std::string& note) {
  if (done_) return;
  fraction_ = 1;
  draw(note);
  if (terminal_) std::fputc('\n', stream_);
  done_ = true;
}

}  // namespace gnomon
