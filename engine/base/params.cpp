// Resolves a pass' parameters from their declaration and the given values, and notes which are read.
#include "engine/base/params.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>

#include "engine/base/error.h"

namespace gnomon {
namespace {

std::string shortest(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  std::string result(text, end);
  // "2" would read back as an integer
  if (std::isfinite(value) && result.find_first_of(".e") == std::string::npos) result += ".0";
  return result;
}

const char* type_name(ParamType type) {
  switch (type) {
    case ParamType::flag:
      return "flag";
    case ParamType::integer:
      return "integer";
    case ParamType::number:
      return "number";
    case ParamType::choice:
      return "choice";
  }
  return "";
}

const ParamSpec* find_spec(const std::vector<ParamSpec>& specs, std::string_view name) {
  const auto found =
      std::find_if(specs.begin(), specs.end(), [&](const ParamSpec& s) { return s.name == name; });
  return found == specs.end() ? nullptr : &*found;
}

std::vector<std::string> names_of(const std::vector<ParamSpec>& specs) {
  std::vector<std::string> names;
  for (const ParamSpec& spec : specs) names.push_back(spec.name);
  return names;
}

}  // namespace

std::string to_string(const Value& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const double* number = std::get_if<double>(&value)) return shortest(*number);
  return std::get<std::string>(value);
}

const Value& Params::at(std::string_view name, ParamType type) const {
  const ParamSpec* spec = find_spec(specs_, name);
  const auto value = values_.find(name);
  const std::string quoted = "'" + std::string(name) + "'";
  if (!spec || value == values_.end())
    fail("a pass reads parameter " + quoted + ", which it does not declare", {}, {},
         did_you_mean(name, names_of(specs_)));
  if (spec->type != type)
    fail("a pass reads parameter " + quoted + " as a " + type_name(type) + "; it declares a " +
         type_name(spec->type));
  read_.insert(spec->name);
  return value->second;
}

bool Params::flag(std::string_view name) const { return std::get<bool>(at(name, ParamType::flag)); }

std::int64_t Params::integer(std::string_view name) const {
  return std::get<std::int64_t>(at(name, ParamType::integer));
}

double Params::number(std::string_view name) const { return std::get<double>(at(name, ParamType::number)); }

const std::string& Params::choice(std::string_view name) const {
  return std::get<std::string>(at(name, ParamType::choice));
}

int Params::choice_index(std::string_view name) const {
  const std::string& value = choice(name);
  const auto& choices = find_spec(specs_, name)->choices;
  return int(std::find(choices.begin(), choices.end(), value) - choices.begin());
}

std::vector<std::string> Params::never_read() const {
  std::vector<std::string> names;
  for (const ParamSpec& spec : specs_)
    if (!read_.contains(spec.name)) names.push_back(spec.name);
  return names;
}

}  // namespace gnomon
