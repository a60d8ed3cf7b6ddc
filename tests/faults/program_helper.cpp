// Runs the program in a folder of the test's own, as a user would.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "tests/faults/program.h"

namespace gnomon::test {

namespace fs = std::filesystem;

namespace {

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

void redirect(const fs::path& file, int to) {
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  dup2(fd, to);
  close(fd);
}

}  // namespace

Program::Program(const std::string& name)
    : folder_(fs::temp_directory_path() / ("gnomon-faults-" + std::to_string(getpid()) + "-" + name)),
      apart_(folder_.string() + "-apart") {
  for (const fs::path& folder : {folder_, apart_}) {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
}

Program::~Program() {
  std::error_code ignored;
  for (const fs::path& folder : {folder_, apart_}) fs::remove_all(folder, ignored);
}

void Program::write(const std::string& name, const std::string& text) const {
  fs::create_directories((folder_ / name).parent_path());
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

std::string Program::read(const std::string& name) const { return text_of(folder_ / name); }

pid_t Program::start(const std::vector<std::string>& arguments,
                     const std::vector<std::string>& environment) const {
  const pid_t process = fork();
  if (process != 0) return process;
  if (chdir(folder_.c_str()) != 0) _exit(127);
  redirect(apart_ / "output", STDOUT_FILENO);
  redirect(apart_ / "error", STDERR_FILENO);
  setenv("GNOMON_CACHE", (apart_ / "cache").c_str(), 1);
  for (const std::string& pair : environment) putenv(const_cast<char*>(pair.c_str()));
  std::vector<char*> words = {const_cast<char*>(GNOMON_EXECUTABLE)};
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  execv(words[0], words.data());
  _exit(127);
}

Ended Program::wait(pid_t process) const {
  int status = 0;
  waitpid(process, &status, 0);
  constexpr int killed = 128;  // as shells report it
  return {WIFEXITED(status) ? WEXITSTATUS(status) : killed + WTERMSIG(status), text_of(apart_ / "output"),
          text_of(apart_ / "error")};
}

Ended Program::run(const std::vector<std::string>& arguments,
                   const std::vector<std::string>& environment) const {
  return wait(start(arguments, environment));
}

std::map<std::string, std::string> Program::content() const {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
    const std::string name = entry.path().lexically_relative(folder_).string();
    entry.is_directory() ? files[name + "/"] : files[name] = text_of(entry.path());
  }
  return files;
}

}  // namespace gnomon::test
