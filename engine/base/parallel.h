// Rows of an image shared among all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/base/interrupt.h"

namespace gnomon {

// Calls row(i) for i in [0, count), each once, from hardware_concurrency threads, the caller's among them.
// `progress` (may be empty) hears 0..1 on the caller's thread. The first exception stops the rest and is
// thrown again here.
template <typename Row>
void parallel_rows(uint32_t count, const std::function<void(double)>& progress, const Row& row) {
  std::atomic<uint32_t> next{0};
  std::exception_ptr error;
  std::mutex error_mutex;
  const auto work = [&](bool tell) {
    try {
      for (uint32_t i = next++; i < count; i = next++) {
        check_interrupt();
        row(i);
        if (tell && progress) progress(static_cast<double>(std::min(next.load(), count)) / count);
      }
    } catch (...) {
      next = count;
      const std::scoped_lock lock(error_mutex);
      if (!error) error = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> threads;
    const uint32_t wanted = std::min(std::max(1u, std::thread::hardware_concurrency()), std::max(1u, count));
    for (uint32_t i = 1; i < wanted; ++i) threads.emplace_back(work, false);
    work(true);
  }
  if (error) std::rethrow_exception(error);
  if (progress) progress(1.0);
}

}  // namespace gnomon
