// Values of a report's JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace gnomon {

// A number at a JSON pointer, when it is there.
inline std::optional<double> figure_at(const nlohmann::json& object, const std::string& pointer) {
  const nlohmann::json::json_pointer at(pointer);
  if (!object.contains(at) || !object.at(at).is_number()) return std::nullopt;
  return object.at(at).get<double>();
}

// As after --set.
inline std::string value_text(const nlohmann::json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace gnomon
