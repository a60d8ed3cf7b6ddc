// Reads the project's own source files, and finds the functions in them.
#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "tests/rules/source_text.h"

namespace gnomon::rules {
namespace fs = std::filesystem;

std::vector<std::string> files(const std::vector<std::string>& folders,
                               const std::vector<std::string>& endings) {
  const fs::path root = GNOMON_TEST_SOURCE_DIR;
  std::vector<std::string> found;
  for (const std::string& folder : folders)
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string name = entry.path().filename().string();
      if (entry.is_regular_file() && std::any_of(endings.begin(), endings.end(),
                                                 [&](const auto& ending) { return name.ends_with(ending); }))
        found.push_back(fs::relative(entry.path(), root).generic_string());
    }
  std::sort(found.begin(), found.end());
  return found;
}

std::string text_of(const std::string& file) {
  std::ifstream in(fs::path(GNOMON_TEST_SOURCE_DIR) / file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& file) {
  std::istringstream in(text_of(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

namespace {

// Where what begins at `at` ends: a comment, a string, a character constant; `at` itself when none does.
size_t end_of_blank(const std::string& text, size_t at) {
  const auto after = [&](const std::string& mark, size_t from) {
    const size_t found = text.find(mark, from);
    return found == std::string::npos ? text.size() : found + mark.size();
  };
  if (text.compare(at, 2, "//") == 0) return after("\n", at) - 1;
  if (text.compare(at, 2, "/*") == 0) return after("*/", at + 2);
  if (text.compare(at, 2, "R\"") == 0) {
    const size_t open = text.find('(', at);
    return after(")" + text.substr(at + 2, open - at - 2) + "\"", open);
  }
  const char quote = text[at];
  if (quote != '"' && quote != '\'') return at;
  if (quote == '\'' && at > 0 && std::isxdigit(static_cast<unsigned char>(text[at - 1]))) return at;  // 1'000
  size_t end = at + 1;
  while (end < text.size() && text[end] != quote) end += text[end] == '\\' ? 2 : 1;
  return std::min(end + 1, text.size());
}

bool opens_scope(const std::string& head) {
  return std::regex_search(head, std::regex("^\\s*(template\\s*<[^{]*>\\s*)?(inline\\s+)?"
                                            "(namespace|class|struct|union|enum|extern)\\b"));
}

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

size_t line_at(const std::string& text, size_t at) {
  return 1 + size_t(std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n'));
}

size_t closing_brace(const std::string& text, size_t open) {
  int depth = 0;
  for (size_t i = open; i < text.size(); ++i) {
    if (text[i] == '{') ++depth;
    if (text[i] == '}' && --depth == 0) return i;
  }
  return text.size() - 1;
}

}  // namespace

std::string without_comments_and_strings(const std::string& text) {
  std::string plain = text;
  for (size_t i = 0; i < text.size();) {
    const size_t end = end_of_blank(text, i);
    for (size_t k = i; k < end; ++k)
      if (text[k] != '\n') plain[k] = ' ';
    i = std::max(end, i + 1);
  }
  return std::regex_replace(plain, std::regex("(^|\n)#[^\n]*"), "$1");
}

std::vector<Function> functions(const std::string& text) {
  const std::string plain = without_comments_and_strings(text);
  std::vector<Function> found;
  size_t begin = 0;  // of the declaration that is being read
  for (size_t i = 0; i < plain.size(); ++i) {
    if (plain[i] == ';' || plain[i] == '}') begin = i + 1;
    if (plain[i] != '{') continue;
    const std::string head = plain.substr(begin, i - begin);
    if (opens_scope(head)) {
      begin = i + 1;
      continue;
    }
    const size_t close = closing_brace(plain, i);
    const std::string words = trimmed(head);
    // Bodies stand after a space, and initialisers of members do not.
    const bool body = plain[i - 1] == ' ' && words.find(')') != std::string::npos && words.back() != '=';
    if (body) {
      const size_t first = plain.find_first_not_of(" \t\n", begin);
      found.push_back({words, line_at(plain, first), line_at(plain, close)});
      begin = close + 1;
    }
    i = close;
  }
  return found;
}

}  // namespace gnomon::rules
