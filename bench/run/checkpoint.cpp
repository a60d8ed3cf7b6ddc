// Keeps the measured frames of an unfinished suite on disk, so that it can be resumed.
#include "bench/run/checkpoint.h"

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/run/results.h"
#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

using Frames = std::vector<FrameTiming> Samples::*;

struct Mode {
  TimingMode mode;
  const char* name;
  Frames frames;
};
constexpr Mode kModes[] = {{TimingMode::none, "plain", &Samples::plain},
                           {TimingMode::overlapped, "overlapped", &Samples::overlapped},
                           {TimingMode::isolated, "isolated", &Samples::isolated}};

json to_json(const FrameTiming& timing) {
  json passes = json::array();
  for (const PassTiming& pass : timing.passes)
    passes.push_back({pass.id, pass.type, pass.iteration, pass.gpu_ms, pass.cpu_ms, pass.host_wait_ms});
  return {{"frame_ms", timing.frame_ms},
          {"record_ms", timing.record_ms},
          {"gpu_ms", timing.gpu_ms},
          {"passes", passes}};
}

FrameTiming timing_of(const json& frame) {
  FrameTiming timing{frame.at("frame_ms"), frame.at("record_ms"), frame.at("gpu_ms"), {}};
  for (const json& pass : frame.at("passes"))
    timing.passes.push_back({pass.at(0), pass.at(1), pass.at(2), pass.at(3), pass.at(4), pass.at(5)});
  return timing;
}

}  // namespace

Checkpoint::Checkpoint(fs::path file, bool go_on) : file_(std::move(file)) {
  if (!go_on) end();
  if (!fs::exists(file_)) return;
  try {
    for (const json& line : read_lines(file_)) {
      group_ = line.at("group");
      for (const Mode& mode : kModes)
        if (line.at("mode") == mode.name)
          (frames_[line.at("row")].*mode.frames).push_back(timing_of(line.at("frame")));
    }
  } catch (const json::exception& error) {
    fail(std::string("not frames of an interrupted suite: ") + error.what(), file_.string(), {},
         "delete the file: the suite then measures its last techniques again");
  }
}

void Checkpoint::begin(const std::string& group) {
  if (group != group_) frames_.clear();
  group_ = group;
  stream_ = std::ofstream(file_, std::ios::binary | std::ios::trunc);
  // Written anew, so that no torn line is in the middle.
  for (const auto& [key, samples] : frames_)
    for (const Mode& mode : kModes)
      for (const FrameTiming& timing : samples.*mode.frames) keep(key, mode.mode, timing);
}

Samples Checkpoint::of(const std::string& key) const {
  const auto found = frames_.find(key);
  return found == frames_.end() ? Samples{} : found->second;
}

void Checkpoint::keep(const std::string& key, TimingMode mode, const FrameTiming& timing) {
  for (const Mode& one : kModes)
    if (one.mode == mode)
      stream_ << json{{"group", group_}, {"row", key}, {"mode", one.name}, {"frame", to_json(timing)}}.dump()
              << '\n';
  stream_.flush();
  if (!stream_) fail(std::string("cannot write: ") + std::strerror(errno), file_.string());
}

void Checkpoint::end() {
  stream_.close();
  group_.clear();
  frames_.clear();
  std::error_code ignored;
  fs::remove(file_, ignored);
}

}  // namespace gnomon
