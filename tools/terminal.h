// What the program prints: names from files cannot steer the terminal.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <type_traits>

#include "engine/base/printable.h"

namespace gnomon {

// Text among the arguments of print() is made printable(); other values are as they are.
template <class T>
auto as_printed(const T& value) {
  if constexpr (std::is_convertible_v<const T&, std::string_view>)
    return printable(value);
  else
    return value;
}

template <class... Args>
void print(std::FILE* stream, fmt::format_string<decltype(as_printed(std::declval<const Args&>()))...> format,
           const Args&... args) {
  fmt::print(stream, format, as_printed(args)...);
}
template <class... Args>
void print(fmt::format_string<decltype(as_printed(std::declval<const Args&>()))...> format,
           const Args&... args) {
  fmt::print(stdout, format, as_printed(args)...);
}

// Text of several lines that was put together from names.
inline void print_lines(std::FILE* stream, const std::string& text) {
  fmt::print(stream, "{}", printable_lines(text));
}

}  // namespace gnomon
