// Names from files on a terminal: what would steer it or pass for another line is shown, not sent.
#pragma once

#include <string>
#include <string_view>

namespace gnomon {

// The text with control characters (C0, DEL, C1), marks that turn the direction of text, line separators and
// bytes that are no UTF-8 written as \n, \t, \x1b or \u202e. Of one line.
std::string printable(std::string_view text);
// The same of several lines: ends of line stay.
std::string printable_lines(std::string_view text);

}  // namespace gnomon
