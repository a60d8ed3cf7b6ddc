// Reads JSON files with comments; every error has a file and a place.
#include "engine/base/config.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "engine/base/json_text.h"

namespace gnomon {
namespace {

using nlohmann::json;

// The integer a JSON number names, however it is spelled (512, 512.0, 5.12e2).
std::optional<int64_t> exact_integer(const json& value) {
  if (value.is_number_unsigned()) {
    const auto number = value.get<uint64_t>();
    if (number > uint64_t(std::numeric_limits<int64_t>::max())) return std::nullopt;
    return int64_t(number);
  }
  if (value.is_number_integer()) return value.get<int64_t>();
  if (!value.is_number_float()) return std::nullopt;
  const double number = value.get<double>();
  constexpr double exact = 9007199254740992.0;  // 2^53
  if (std::trunc(number) != number || std::abs(number) > exact) return std::nullopt;
  return int64_t(number);
}

void append_canonical(std::string& out, const json& value);

void append_canonical_object(std::string& out, const json& value) {
  out += '{';
  for (const auto& [key, member] : value.items()) {  // sorted: nlohmann::json's objects are std::map
    append_quoted(out, key);
    out += ':';
    append_canonical(out, member);
    out += ',';
  }
  out += '}';
}

void append_canonical(std::string& out, const json& value) {
  if (value.is_object()) {
    append_canonical_object(out, value);
  } else if (value.is_array()) {
    out += '[';
    for (const json& item : value) {
      append_canonical(out, item);
      out += ',';
    }
    out += ']';
  } else if (const auto integer = exact_integer(value)) {
    out += std::to_string(*integer);
  } else if (value.is_number()) {
    out += to_string(Value(value.get<double>()));
  } else if (value.is_string()) {
    append_quoted(out, value.get_ref<const std::string&>());
  } else {
    out += value.dump();
  }
}

// FNV-1a, 64 bits.
uint64_t fnv1a(const std::string& text) {
  uint64_t hash = 14695981039346656037ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return hash;
}

template <typename T>
std::optional<T> whole_number(const std::string& text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

}  // namespace

struct ObjectReader::Impl {
  const json* object;
  std::string file, place;
  Problems& problems;
  std::set<std::string> asked = {};

  void wrong_type(const std::string& key, const json& value, const std::string& must) {
    problems.add(in_quotes(key) + " is " + shown(value) + ": must be " + must, file, pointer_to(place, key));
  }
};

ObjectReader::ObjectReader(const json& object, std::string file, std::string place, Problems& problems)
    : impl_(new Impl{object.is_object() ? &object : nullptr, std::move(file), std::move(place), problems}) {
  if (!impl_->object) problems.add("is " + shown(object) + ": must be an object", impl_->file, impl_->place);
}

ObjectReader::~ObjectReader() { delete impl_; }

const json* ObjectReader::find(const std::string& key) {
  impl_->asked.insert(key);
  if (!impl_->object) return nullptr;
  const auto found = impl_->object->find(key);
  return found == impl_->object->end() ? nullptr : &*found;
}

std::string ObjectReader::text(const std::string& key, std::string standard) {
  const json* value = find(key);
  if (!value) return standard;
  if (value->is_string()) return value->get<std::string>();
  impl_->wrong_type(key, *value, "a string");
  return standard;
}

std::string ObjectReader::required_text(const std::string& key) {
  if (impl_->object && !find(key)) impl_->problems.add("'" + key + "' is missing", impl_->file, impl_->place);
  return text(key, {});
}

double ObjectReader::number(const std::string& key, double standard) {
  const json* value = find(key);
  if (!value) return standard;
  if (value->is_number()) return value->get<double>();
  impl_->wrong_type(key, *value, "a number");
  return standard;
}

long long ObjectReader::integer(const std::string& key, long long standard) {
  const json* value = find(key);
  if (!value) return standard;
  if (const auto integer = exact_integer(*value)) return *integer;
  impl_->wrong_type(key, *value, "an integer");
  return standard;
}

void ObjectReader::finish() {
  if (!impl_->object) return;
  const std::vector<std::string> known(impl_->asked.begin(), impl_->asked.end());
  for (const auto& [key, value] : impl_->object->items())
    if (!impl_->asked.contains(key))
      impl_->problems.add("unknown key " + in_quotes(key), impl_->file, pointer_to(impl_->place, key),
                          did_you_mean(key, known));
}

std::string ObjectReader::place_of(const std::string& key) const { return pointer_to(impl_->place, key); }

std::string canonical_hash(const json& value) {
  std::string text;
  append_canonical(text, value);
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(fnv1a(text)));
  return digits;
}

Value to_value(const json& value, const std::string& file, const std::string& place, Problems& problems) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return value.get<double>();
  if (const auto integer = exact_integer(value)) return *integer;
  if (value.is_number()) {
    problems.add("is " + shown(value) + ": too large for an integer", file, place);
  } else {
    problems.add("is " + shown(value) + ": must be true, false, a number or a string", file, place);
  }
  return int64_t{0};
}

Value parse_value(const std::string& text) {
  if (text == "true") return true;
  if (text == "false") return false;
  if (const auto integer = whole_number<int64_t>(text)) return *integer;
  const auto number = whole_number<double>(text);
  if (number && std::isfinite(*number)) return *number;
  return text;
}

std::vector<Values> expand_sweep(const json& set, const std::string& file, const std::string& place,
                                 Problems& problems) {
  constexpr size_t most = 100000;  // combinations; more is surely a mistake
  std::vector<Values> rows{{}};
  if (!set.is_object()) {
    problems.add("is " + shown(set) + ": must be an object", file, place);
    return rows;
  }
  for (const auto& [name, given] : set.items()) {
    const std::string here = pointer_to(place, name);
    const json choices = given.is_array() ? given : json::array({given});
    if (choices.empty()) problems.add(in_quotes(name) + " is swept over nothing", file, here);
    if (rows.size() * choices.size() > most) {
      problems.add("the sweep has more than " + std::to_string(most) + " combinations", file, here);
      return {};
    }
    std::vector<Value> values;
    for (size_t i = 0; i < choices.size(); ++i)
      values.push_back(to_value(choices[i], file, given.is_array() ? pointer_to(here, i) : here, problems));
    std::vector<Values> longer;
    for (const Values& row : rows)
      for (const Value& value : values) {
        longer.push_back(row);
        longer.back()[name] = value;
      }
    rows = std::move(longer);
  }
  return rows;
}

}  // namespace gnomon
