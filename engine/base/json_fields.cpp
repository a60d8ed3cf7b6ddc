// Reads values of JSON; a value of another kind is an error that names its place.
#include "engine/base/json_fields.h"

#include "engine/base/error.h"
#include "engine/base/json_text.h"

namespace gnomon {

JsonPlace JsonPlace::at(const std::string& key) const { return {file, line, pointer_to(pointer, key)}; }
JsonPlace JsonPlace::at(size_t index) const { return {file, line, pointer_to(pointer, index)}; }

void fail_field(const char* must_be, const JsonPlace& place) {
  std::string where = place.line;
  if (!where.empty() && !place.pointer.empty()) where += ": ";
  fail(std::string("must be ") + must_be, place.file, where + place.pointer);
}

void FieldReader::read(const nlohmann::json& json, bool& value, const JsonPlace& place) {
  if (json.is_null()) return;
  if (!json.is_boolean()) fail_field("true or false", place);
  value = json.get<bool>();
}

void FieldReader::read(const nlohmann::json& json, double& value, const JsonPlace& place) {
  if (!json.is_null() && !json.is_number()) fail_field("a number", place);
  value = json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

void FieldReader::read(const nlohmann::json& json, std::string& value, const JsonPlace& place) {
  if (json.is_null()) return;
  if (!json.is_string()) fail_field("a string", place);
  value = json.get<std::string>();
}

void FieldReader::read(const nlohmann::json& json, std::filesystem::path& value, const JsonPlace& place) {
  std::string text = value.string();
  read(json, text, place);
  value = text;
}

void FieldReader::read(const nlohmann::json& json, Value& value, const JsonPlace& place) {
  if (json.is_boolean())
    value = json.get<bool>();
  else if (json.is_number_integer())
    value = json.get<std::int64_t>();
  else if (json.is_number())
    value = json.get<double>();
  else if (json.is_string())
    value = json.get<std::string>();
  else
    fail_field("a number, a string, true or false", place);
}

void FieldReader::read(const nlohmann::json& json, FieldPair& value, const JsonPlace& place) {
  if (!json.is_array() || json.size() != 2) fail_field("two numbers", place);
  for (size_t i = 0; i < 2; ++i) read(json[i], value[i], place.at(i));
}

void FieldReader::read(const nlohmann::json& json, Extent& value, const JsonPlace& place) {
  if (!json.is_array() || json.size() != 2) fail_field("two integers", place);
  read(json[0], value.width, place.at(size_t{0}));
  read(json[1], value.height, place.at(size_t{1}));
}

uint64_t FieldReader::count(const nlohmann::json& json, uint64_t most, const JsonPlace& place) {
  const bool negative = json.is_number_integer() && !json.is_number_unsigned() && json.get<int64_t>() < 0;
  if (!json.is_number_integer() || negative || json.get<uint64_t>() > most) fail_field("a count", place);
  return json.get<uint64_t>();
}

}  // namespace gnomon
