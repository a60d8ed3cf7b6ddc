// JSON pointers, and JSON values as they appear in messages.
#include "engine/base/json_text.h"

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

constexpr size_t kLongest = 64;

std::string cut(std::string text) {
  if (text.size() <= kLongest) return text;
  size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
    --end;  // not inside a UTF-8 sequence
  text.resize(end);
  return text + "...";
}

}  // namespace

std::string pointer_to(const std::string& place, const std::string& key) {
  std::string result = place + "/";
  for (const char c : key) {
    if (c == '~') {
      result += "~0";
    } else if (c == '/') {
      result += "~1";
    } else {
      result += c;
    }
  }
  return result;
}

std::string pointer_to(const std::string& place, size_t index) { return place + "/" + std::to_string(index); }

std::string shown(const nlohmann::json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "an array";
  return cut(value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string in_quotes(const std::string& text) { return "'" + cut(text) + "'"; }

void append_quoted(std::string& out, const std::string& text) {
  out += nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace gnomon
