// JSON with comments, read so that every error has a file and a place.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/params.h"

namespace gnomon {

// Parses a file (comments allowed, duplicate keys are errors with their place). Error: file, line and column.
nlohmann::json read_json(const std::filesystem::path& file);
// Nested deeper than 64 levels: Error, since readers recurse. `first_line`: of the text in its file.
nlohmann::json parse_json(const std::string& text, const std::string& file_for_errors, size_t first_line = 1);

// Reads an object's members by name; finish() reports every member that nobody asked for, with "did you
// mean".
class ObjectReader {
 public:
  ObjectReader(const nlohmann::json& object, std::string file, std::string place, Problems& problems);
  ~ObjectReader();
  ObjectReader(const ObjectReader&) = delete;
  ObjectReader& operator=(const ObjectReader&) = delete;
  const nlohmann::json* find(const std::string& key);  // nullptr when absent
  std::string text(const std::string& key, std::string standard);
  std::string required_text(const std::string& key);
  double number(const std::string& key, double standard);
  long long integer(const std::string& key, long long standard);
  void finish();
  std::string place_of(const std::string& key) const;  // JSON pointer of a member

 private:
  struct Impl;
  Impl* impl_;
};

// Stable across member order and number spelling; 16 hex digits.
std::string canonical_hash(const nlohmann::json& value);

// JSON -> Value: bool, integer, number, string. Problem otherwise.
Value to_value(const nlohmann::json& value, const std::string& file, const std::string& place,
               Problems& problems);
// "--set name=text": true/false, integer, number, else string.
Value parse_value(const std::string& text);

// {"kernel": [7, 15], "shadow_map": 512} -> every combination, the first variable (in name order) slowest.
std::vector<Values> expand_sweep(const nlohmann::json& set, const std::string& file, const std::string& place,
                                 Problems& problems);

}  // namespace gnomon
