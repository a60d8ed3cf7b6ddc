// Runs the program in a folder of the test's own, as a user would.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace gnomon::test {

struct Ended {
  int status = -1;  // exit status; 128 + signal where a signal ended it
  std::string output, error;
};

class Program {
 public:
  explicit Program(const std::string& name);  // makes an empty folder, and the caches of the program in it
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  // `environment`: "NAME=value" beside the test's own.
  Ended run(const std::vector<std::string>& arguments,
            const std::vector<std::string>& environment = {}) const;
  pid_t start(const std::vector<std::string>& arguments,
              const std::vector<std::string>& environment = {}) const;
  Ended wait(pid_t process) const;
  // Content of every file below the folder, by its path; folders as "name/". Without the caches.
  std::map<std::string, std::string> content() const;

 private:
  std::filesystem::path folder_, apart_;  // apart: caches and what the program prints
};

}  // namespace gnomon::test
