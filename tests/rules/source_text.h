// The project's own source files as text, and where functions begin and end in them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon::rules {

// Paths below the project's folder, sorted; of the files in `folders` that end in one of `endings`.
std::vector<std::string> files(const std::vector<std::string>& folders,
                               const std::vector<std::string>& endings);

std::string text_of(const std::string& file);
std::vector<std::string> lines_of(const std::string& file);

// Comments, strings and character constants as blanks; lines stay where they are.
std::string without_comments_and_strings(const std::string& text);

struct Function {
  std::string head;            // its last words before the body
  size_t first = 0, last = 0;  // lines, counted from 1: of the beginning of its declaration and of its "}"
  size_t lines() const { return last - first + 1; }
};
// Functions at namespace and class scope; what is defined inside of a function belongs to it. C++ as this
// project writes it: no macro opens or closes a brace.
std::vector<Function> functions(const std::string& text);

}  // namespace gnomon::rules
