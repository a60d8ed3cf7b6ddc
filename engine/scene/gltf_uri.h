// What the URIs of a glTF file name: data URIs (RFC 2397) and files beside it (RFC 3986). Internal to the
// scene loader.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

using Bytes = std::vector<unsigned char>;

constexpr uint64_t kMaxFileSize = 0x7FFFFFFF;  // bytes of one file of a scene: glTF's readers count in int

// For messages: a data URI is cut to 40 characters.
std::string shown_uri(const std::string& uri);

// "%2B" becomes "+"; a "+" stays one, and so does a "%" that begins no escape.
std::string percent_decoded(const std::string& text);

// What the URI names, at most `most` bytes of it. Error, without file and place: not a data URI nor a
// relative reference, malformed, no such file, not a regular file, larger than kMaxFileSize.
Bytes read_uri(const std::filesystem::path& folder, const std::string& uri, uint64_t most = kMaxFileSize);

// The URI names a file outside `folder`, by "..", a link or an absolute path.
bool is_outside(const std::filesystem::path& folder, const std::string& uri);

// A whole regular file. Error, without file and place, as above.
Bytes read_bytes(const std::filesystem::path& path, uint64_t most = kMaxFileSize);

}  // namespace gnomon
