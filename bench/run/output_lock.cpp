// A file that is locked for as long as its process lives.
#include "bench/run/output_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "engine/base/error.h"

namespace gnomon {
namespace {

std::string owner() {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  return fmt::format("process {} on {}", getpid(), host);
}

// Whether the name still leads to the open file: its owner removes it when done.
bool is_there(int descriptor, const std::filesystem::path& file) {
  struct stat open_file {
  }, named{};
  return fstat(descriptor, &open_file) == 0 && stat(file.c_str(), &named) == 0 &&
         open_file.st_ino == named.st_ino && open_file.st_dev == named.st_dev;
}

}  // namespace

OutputLock::OutputLock(const std::filesystem::path& folder) : file_(folder / "in-use") {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail("cannot make the folder: " + error.message(), folder.string());
  do {
    if (descriptor_ >= 0) close(descriptor_);
    take();
  } while (!is_there(descriptor_, file_));
  const std::string text = owner() + "\n";
  if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, text.data(), text.size(), 0) < 0) {
    // Without a name in it the lock holds all the same (full disk).
  }
}

void OutputLock::take() {
  descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (descriptor_ < 0) fail(std::string("cannot write: ") + std::strerror(errno), file_.string());
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const int reason = errno;
  close(descriptor_);
  if (reason != EWOULDBLOCK) {  // a file system without locks
    fail(std::string("cannot be locked: ") + std::strerror(reason), file_.string());
  }
  std::ifstream stream(file_);
  std::string who;
  std::getline(stream, who);
  fail(fmt::format("{} writes results here", who.empty() ? "another process" : who),
       file_.parent_path().string(), {}, "wait for it, or take another folder with --out");
}

OutputLock::~OutputLock() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
  close(descriptor_);
}

}  // namespace gnomon
