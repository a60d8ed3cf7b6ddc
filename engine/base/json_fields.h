// Structs to JSON and back by one list of their members' names:
//
//   template <class Io>
//   void fields(Io& io, typename Io::template Of<Point>& point) {
//     io("x", point.x);
//     io("y", point.y);
//   }
//
// writes a Point, reads one, and finds a figure of one by its name. What does not exist is null: an absent
// optional, or a number that is not finite.
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/base/params.h"
#include "engine/base/shape.h"

namespace gnomon {

// Where a value that is read stands, for messages.
struct JsonPlace {
  std::string file;
  std::string line;          // "line 3"; may be empty
  std::string pointer = {};  // JSON pointer
  JsonPlace at(const std::string& key) const;
  JsonPlace at(size_t index) const;
};

// Error: "FILE: line 3: /frame_ms/median: must be a number".
[[noreturn]] void fail_field(const char* must_be, const JsonPlace& place);

template <class T>
struct FieldKind {
  static constexpr bool optional = false, list = false, map = false;
};
template <class T>
struct FieldKind<std::optional<T>> {
  static constexpr bool optional = true, list = false, map = false;
};
template <class T>
struct FieldKind<std::vector<T>> {
  static constexpr bool optional = false, list = true, map = false;
};
template <class T, class Less>
struct FieldKind<std::map<std::string, T, Less>> {
  static constexpr bool optional = false, list = false, map = true;
};
using FieldPair = std::array<double, 2>;

class FieldWriter {
 public:
  static constexpr bool reads = false;
  template <class T>
  using Of = const T;
  template <class T>
  void operator()(const char* name, const T& value) {
    object_[name] = written(value);
  }
  // A member that is left out when it is empty.
  template <class T>
  void unless_empty(const char* name, const T& value) {
    bool empty = false;
    if constexpr (FieldKind<T>::optional)
      empty = !value.has_value();
    else
      empty = value.empty();
    if (!empty) (*this)(name, value);
  }
  nlohmann::json take() { return std::move(object_); }

  template <class T>
  static nlohmann::json written(const T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
    } else if constexpr (FieldKind<T>::optional) {
      return value ? written(*value) : nlohmann::json();
    } else if constexpr (FieldKind<T>::list) {
      nlohmann::json list = nlohmann::json::array();
      for (const auto& one : value) list.push_back(written(one));
      return list;
    } else if constexpr (FieldKind<T>::map) {
      nlohmann::json object = nlohmann::json::object();
      for (const auto& [name, one] : value) object[name] = written(one);
      return object;
    } else if constexpr (std::is_same_v<T, Value>) {
      return std::visit([](const auto& one) { return nlohmann::json(one); }, value);
    } else if constexpr (std::is_same_v<T, FieldPair>) {
      return nlohmann::json::array({written(value[0]), written(value[1])});
    } else if constexpr (std::is_same_v<T, Extent>) {
      return nlohmann::json::array({value.width, value.height});
    } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
      return value.string();
    } else if constexpr (std::is_same_v<T, std::string> || std::is_arithmetic_v<T>) {
      return nlohmann::json(value);
    } else {
      FieldWriter inner;
      fields(inner, value);
      return inner.take();
    }
  }

 private:
  nlohmann::json object_ = nlohmann::json::object();
};

// Members that are not there keep their value; those that no list names are ignored.
class FieldReader {
 public:
  static constexpr bool reads = true;
  template <class T>
  using Of = T;
  // Error: no object.
  FieldReader(const nlohmann::json& object, const JsonPlace& place) : object_(object), place_(place) {
    if (!object.is_object()) fail_field("an object", place);
  }
  template <class T>
  void operator()(const char* name, T& value) const {
    if (const auto found = object_.find(name); found != object_.end()) read(*found, value, place_.at(name));
  }
  template <class T>
  void unless_empty(const char* name, T& value) const {
    (*this)(name, value);
  }

  static void read(const nlohmann::json& json, bool& value, const JsonPlace& place);
  static void read(const nlohmann::json& json, double& value, const JsonPlace& place);  // null: NaN
  static void read(const nlohmann::json& json, std::string& value, const JsonPlace& place);
  static void read(const nlohmann::json& json, std::filesystem::path& value, const JsonPlace& place);
  static void read(const nlohmann::json& json, Value& value, const JsonPlace& place);
  static void read(const nlohmann::json& json, FieldPair& value, const JsonPlace& place);
  static void read(const nlohmann::json& json, Extent& value, const JsonPlace& place);
  static uint64_t count(const nlohmann::json& json, uint64_t most, const JsonPlace& place);

  template <class T>
  static void read(const nlohmann::json& json, T& value, const JsonPlace& place) {
    if constexpr (FieldKind<T>::optional) {
      constexpr bool null_is_one = std::is_same_v<T, std::optional<double>>;  // there, and not finite
      if (json.is_null() && !null_is_one)
        value.reset();
      else
        read(json, value.emplace(), place);
    } else if (json.is_null()) {
      return;
    } else if constexpr (FieldKind<T>::list) {
      if (!json.is_array()) fail_field("a list", place);
      value.clear();
      for (const nlohmann::json& one : json) read(one, value.emplace_back(), place.at(value.size() - 1));
    } else if constexpr (FieldKind<T>::map) {
      if (!json.is_object()) fail_field("an object", place);
      value.clear();
      for (const auto& [name, one] : json.items()) read(one, value[name], place.at(name));
    } else if constexpr (std::is_integral_v<T>) {
      value = static_cast<T>(count(json, std::numeric_limits<T>::max(), place));
    } else {
      FieldReader inner(json, place);
      fields(inner, value);
    }
  }

 private:
  const nlohmann::json& object_;
  JsonPlace place_;
};

// The figure of a name, when it is there and finite.
class FieldFinder {
 public:
  static constexpr bool reads = false;
  template <class T>
  using Of = const T;
  explicit FieldFinder(std::string_view name) : name_(name) {}
  template <class T>
  void operator()(const char* name, const T& value) {
    if (name != name_) return;
    if constexpr (std::is_floating_point_v<T>)
      note(value);
    else if constexpr (std::is_same_v<T, std::optional<double>>)
      note(value.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  template <class T>
  void unless_empty(const char* name, const T& value) {
    (*this)(name, value);
  }
  std::optional<double> found() const { return found_; }

 private:
  void note(double value) {
    if (std::isfinite(value)) found_ = value;
  }
  std::string_view name_;
  std::optional<double> found_;
};

}  // namespace gnomon
