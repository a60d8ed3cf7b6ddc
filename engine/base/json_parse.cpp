// Parses JSON with comments; duplicate keys and syntax errors are reported with their place.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "engine/base/config.h"
#include "engine/base/input_file.h"
#include "engine/base/json_text.h"

namespace gnomon {
namespace {

using nlohmann::json;

// "line 3, column 14" of a byte offset; the text begins with line `first_line`, columns count from 1.
std::string line_and_column(const std::string& text, size_t byte, size_t first_line) {
  byte = std::min(byte, text.size());
  const auto end = text.begin() + std::ptrdiff_t(byte);
  const auto line = std::ptrdiff_t(first_line) + std::count(text.begin(), end, '\n');
  const size_t newline = byte == 0 ? std::string::npos : text.rfind('\n', byte - 1);
  const size_t column = newline == std::string::npos ? byte + 1 : byte - newline;
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

// nlohmann's messages carry an exception number and the position; neither is for the reader.
std::string plain(const std::string& message) {
  const size_t colon = message.find(": ");
  return colon == std::string::npos ? message : message.substr(colon + 2);
}

// Builds the document while it watches for duplicate keys, which a parsed object no longer shows, and for
// depth.
class Builder : public json::json_sax_t {
 public:
  Builder(const std::string& text, const std::string& file, size_t first_line)
      : text_(text), file_(file), first_line_(first_line) {}

  bool null() override { return value(nullptr); }
  bool boolean(bool v) override { return value(v); }
  bool number_integer(number_integer_t v) override { return value(v); }
  bool number_unsigned(number_unsigned_t v) override { return value(v); }
  bool number_float(number_float_t v, const string_t&) override { return value(v); }
  bool string(string_t& v) override { return value(std::move(v)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(size_t) override { return open(json::object()); }
  bool start_array(size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    Level& level = levels_.back();
    level.key = std::move(name);
    if (!level.keys.insert(level.key).second)
      problems_.add("duplicate key " + in_quotes(level.key), file_, place() + pointer_to("", level.key));
    return true;
  }
  bool parse_error(size_t position, const std::string& last, const json::exception& error) override {
    (void)last;
    problems_.add(tidy(error.what()), file_,
                  line_and_column(text_, position == 0 ? 0 : position - 1, first_line_));
    return false;
  }

  json take() {
    problems_.raise();
    return std::move(root_);
  }

 private:
  struct Level {
    json* node;
    std::string key;                  // of an object: the member being read
    std::set<std::string> keys = {};  // of an object
  };

  // "... at line 1, column 4: syntax error while parsing value - unexpected ..." -> from "syntax error" on
  static std::string tidy(const std::string& what) {
    const size_t start = what.find("syntax error");
    if (start != std::string::npos) return what.substr(start);
    return plain(what.substr(std::min(what.find("] ") + 2, what.size())));
  }

  // JSON pointer of the innermost open container.
  std::string place() const {
    std::string result;
    for (size_t i = 0; i + 1 < levels_.size(); ++i) {
      const Level& level = levels_[i];
      result = level.node->is_object() ? pointer_to(result, level.key)
                                       : pointer_to(result, level.node->size() - 1);
    }
    return result;
  }

  template <typename T>
  json* place_value(T&& v) {
    if (levels_.empty()) return &(root_ = json(std::forward<T>(v)));
    Level& level = levels_.back();
    if (level.node->is_object()) return &((*level.node)[level.key] = json(std::forward<T>(v)));
    level.node->push_back(json(std::forward<T>(v)));
    return &level.node->back();
  }
  template <typename T>
  bool value(T&& v) {
    place_value(std::forward<T>(v));
    return true;
  }
  bool open(json container) {
    constexpr size_t deepest = 64;  // what reads the document may recurse
    if (levels_.size() >= deepest) {
      problems_.add("nested deeper than " + std::to_string(deepest) + " levels", file_, place());
      return false;
    }
    json* node = place_value(std::move(container));
    levels_.push_back({node, {}});
    return true;
  }
  bool close() {
    levels_.pop_back();
    return true;
  }

  const std::string& text_;
  const std::string& file_;
  const size_t first_line_;
  json root_;
  std::vector<Level> levels_;
  Problems problems_;
};

}  // namespace

json parse_json(const std::string& text, const std::string& file_for_errors, size_t first_line) {
  Builder builder(text, file_for_errors, first_line);
  const bool whole = json::sax_parse(text, &builder, json::input_format_t::json, true, true);
  json result = builder.take();
  if (!whole) fail("not a JSON document", file_for_errors);
  return result;
}

json read_json(const std::filesystem::path& file) { return parse_json(read_input_file(file), file.string()); }

}  // namespace gnomon
