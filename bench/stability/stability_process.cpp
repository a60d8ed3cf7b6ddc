// Runs work in a process of its own, so that a crash of the driver ends that process alone.
#include "bench/stability/stability_process.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include "engine/base/error.h"
#include "engine/base/interrupt.h"

namespace gnomon {
namespace {

using Clock = std::chrono::steady_clock;

void write_all(int to, const std::string& text) {
  for (size_t done = 0; done < text.size();) {
    const ssize_t n = write(to, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    done += static_cast<size_t>(n);
  }
}

constexpr int kStatusNoMemory = 101, kStatusException = 102;  // of the child, when the work threw

[[noreturn]] void child(const std::function<std::string()>& work, uint64_t most_bytes, int to) {
  const rlimit memory{most_bytes, most_bytes}, no_core{0, 0};
  setrlimit(RLIMIT_AS, &memory);
  setrlimit(RLIMIT_CORE, &no_core);
  int status = 0;
  try {
    write_all(to, work());
  } catch (const std::bad_alloc&) {
    status = kStatusNoMemory;
  } catch (const std::exception& error) {
    write_all(to, error.what());
    status = kStatusException;
  } catch (const Interrupted&) {  // the parent ends, too
    status = kStatusException;
  }
  _exit(status);  // destructors of what the parent owns are the parent's
}

// Until the end of file, the deadline or an interruption.
bool read_all(int from, Clock::time_point deadline, std::string& text) {
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd wait{from, POLLIN, 0};
    const int ready = poll(&wait, 1, left > 0 ? static_cast<int>(left) : 0);
    if (ready <= 0) return false;
    char block[4096];
    const ssize_t n = read(from, block, sizeof block);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return true;
    text.append(block, static_cast<size_t>(n));
  }
}

int wait_for(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

ChildOutcome outcome_of(int status, std::string text) {
  using Ended = ChildOutcome::Ended;
  if (WIFSIGNALED(status))
    return {Ended::crashed, fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))};
  if (WEXITSTATUS(status) == 0) return {Ended::done, std::move(text)};
  if (WEXITSTATUS(status) == kStatusNoMemory) return {Ended::crashed, "out of memory"};
  if (WEXITSTATUS(status) == kStatusException) return {Ended::crashed, std::move(text)};
  return {Ended::crashed, fmt::format("exit status {}", WEXITSTATUS(status))};
}

}  // namespace

ChildOutcome run_in_child(const std::function<std::string()>& work, double most_seconds,
                          uint64_t most_bytes) {
  int ends[2];
  if (pipe(ends) != 0) fail(fmt::format("no pipe: {}", std::strerror(errno)));
  const pid_t pid = fork();
  if (pid < 0) fail(fmt::format("no further process: {}", std::strerror(errno)));
  if (pid == 0) {
    close(ends[0]);
    child(work, most_bytes, ends[1]);
  }
  close(ends[1]);
  std::string text;
  const auto deadline = Clock::now() + std::chrono::milliseconds(static_cast<int64_t>(1000 * most_seconds));
  const bool ended = read_all(ends[0], deadline, text);
  if (!ended) kill(pid, SIGKILL);
  close(ends[0]);
  const int status = wait_for(pid);
  check_interrupt();
  if (!ended) return {ChildOutcome::Ended::timed_out, fmt::format("no answer in {:g} s", most_seconds)};
  return outcome_of(status, std::move(text));
}

uint64_t child_memory() {
  return static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGE_SIZE)) / 4 *
         3;
}

}  // namespace gnomon
