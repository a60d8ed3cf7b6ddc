// Preloaded into the program: from the n-th write to a regular file on, the disk is full (GNOMON_FULL_AFTER).
#include <dlfcn.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>

namespace {

bool full(int file) {
  static const char* const after = std::getenv("GNOMON_FULL_AFTER");
  static const long limit = after != nullptr ? std::atol(after) : -1;
  static std::atomic<long> writes{0};
  struct stat status {};
  if (limit < 0 || fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return false;
  return ++writes > limit;
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" ssize_t write(int file, const void* bytes, size_t count) {
  static auto* const real = next<ssize_t(int, const void*, size_t)>("write");
  if (full(file)) return errno = ENOSPC, -1;
  return real(file, bytes, count);
}

extern "C" ssize_t writev(int file, const iovec* parts, int count) {
  static auto* const real = next<ssize_t(int, const iovec*, int)>("writev");
  if (full(file)) return errno = ENOSPC, -1;
  return real(file, parts, count);
}
