// Typed parameters of a pass: schema (declared), values (resolved), and proof that each one is used.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace gnomon {

using Value = std::variant<bool, std::int64_t, double, std::string>;
using Values = std::map<std::string, Value, std::less<>>;

std::string to_string(const Value& value);  // shortest text that reads back as the same value

enum class ParamType { flag, integer, number, choice };

struct ParamSpec {
  std::string name;
  ParamType type = ParamType::number;
  Value default_value;
  double min = 0, max = 0;           // inclusive range of integers and numbers
  std::vector<std::string> choices;  // of a choice, in order; the index is the value GLSL sees
  std::string unit;                  // "texels", "world units", "1" for a plain ratio, ...
  std::string help;
  std::string from = {};  // the input whose traits say the value; empty: a graph file does
};

// The values of one pass instance, complete (defaults filled in) and in range. Look-ups are remembered, so
// that a parameter that nobody reads is found by the tests. A wrong name or type is a programming error:
// Error.
class Params {
 public:
  Params() = default;
  Params(std::vector<ParamSpec> specs, Values values)
      : specs_(std::move(specs)), values_(std::move(values)) {}

  bool flag(std::string_view name) const;
  std::int64_t integer(std::string_view name) const;
  double number(std::string_view name) const;
  const std::string& choice(std::string_view name) const;
  int choice_index(std::string_view name) const;

  const std::vector<ParamSpec>& specs() const { return specs_; }
  const Values& values() const { return values_; }
  std::vector<std::string> never_read() const;

 private:
  const Value& at(std::string_view name, ParamType type) const;
  std::vector<ParamSpec> specs_;
  Values values_;
  mutable std::set<std::string, std::less<>> read_;
};

}  // namespace gnomon
