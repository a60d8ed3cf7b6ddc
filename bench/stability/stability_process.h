// Work in a process of its own, so that a crash or a hang of the driver ends that process alone.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace gnomon {

struct ChildOutcome {
  enum class Ended { done, crashed, timed_out } ended = Ended::done;
  std::string text;  // what the work returned; of a crash, what ended the process
};
// `work` runs in a copy of this process, which must have started no thread and opened no device. Memory
// beyond `most_bytes` of address space cannot be had there. Error when there can be no further process.
ChildOutcome run_in_child(const std::function<std::string()>& work, double most_seconds, uint64_t most_bytes);
// Three quarters of this machine's memory.
uint64_t child_memory();

}  // namespace gnomon
