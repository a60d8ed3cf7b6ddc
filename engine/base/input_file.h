// Files that somebody names: only regular ones are read, up to a stated size.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace gnomon {

// JSON, text and images; scenes have limits of their own.
inline constexpr uint64_t kMostInputBytes = uint64_t{1} << 30;

// Error: it is not there, a folder, a pipe, socket or device (which may never end), or larger than
// `most_bytes`.
void check_input_file(const std::filesystem::path& file, uint64_t most_bytes = kMostInputBytes);
// The whole file. Error as above, or when it cannot be read.
std::string read_input_file(const std::filesystem::path& file, uint64_t most_bytes = kMostInputBytes);

}  // namespace gnomon
