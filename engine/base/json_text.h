// JSON pointers (RFC 6901) and JSON text for messages.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace gnomon {

// place + "/" + key, with '~' and '/' of the key escaped.
std::string pointer_to(const std::string& place, const std::string& key);
std::string pointer_to(const std::string& place, size_t index);
// The value as JSON, cut after 64 characters.
std::string shown(const nlohmann::json& value);
// The text in single quotes, cut after 64 characters.
std::string in_quotes(const std::string& text);
// Appends the text in double quotes, escaped as JSON.
void append_quoted(std::string& out, const std::string& text);

}  // namespace gnomon
