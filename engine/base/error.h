// What went wrong, where, and what to do about it. The one exception type of the project.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

struct Problem {
  std::string what;   // one sentence, lower case, no full stop: "unknown pass type 'gbufer'"
  std::string file;   // file the problem is in; empty when there is none
  std::string place;  // JSON pointer ("/passes/2/in/depth"), "line 12", node name, ...; may be empty
  std::string hint;   // what to do: "did you mean 'gbuffer'?"; may be empty
};

// "file: place: what (hint)"
std::string to_string(const Problem& problem);

// Carries one or more problems; what() is one line per problem. Tools exit with status 2 on it.
class Error : public std::runtime_error {
 public:
  explicit Error(Problem problem);
  explicit Error(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

[[noreturn]] void fail(std::string what, std::string file = {}, std::string place = {},
                       std::string hint = {});

// Collects problems so that all of them are reported once.
class Problems {
 public:
  void add(std::string what, std::string file = {}, std::string place = {}, std::string hint = {});
  bool empty() const { return problems_.empty(); }
  const std::vector<Problem>& all() const { return problems_; }
  void raise() const;  // throws Error when there is any

 private:
  std::vector<Problem> problems_;
};

// "did you mean 'x'?" for the candidate nearest to `name` (edit distance at most a third of its length, or
// 2); otherwise "one of: a, b, c" when there are at most 12 candidates; otherwise empty.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

}  // namespace gnomon
