// Files that somebody names: only regular ones are read, up to a stated size.
#include "engine/base/input_file.h"

#include <fstream>

#include "engine/base/error.h"

namespace gnomon {

namespace fs = std::filesystem;

void check_input_file(const fs::path& file, uint64_t most_bytes) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) fail("no such file", file.string());
  if (fs::is_directory(status)) fail("is a folder, not a file", file.string());
  if (!fs::is_regular_file(status)) fail("is a pipe or device, not a file", file.string());
  const uint64_t size = fs::file_size(file, error);
  if (error) fail("cannot be read: " + error.message(), file.string());
  if (size > most_bytes)
    fail("has " + std::to_string(size) + " bytes, more than the " + std::to_string(most_bytes) +
             " that are read",
         file.string());
}

std::string read_input_file(const fs::path& file, uint64_t most_bytes) {
  check_input_file(file, most_bytes);
  std::error_code error;
  std::string text(fs::file_size(file, error), '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(text.data(), std::streamsize(text.size())) || error) fail("cannot be read", file.string());
  return text;
}

}  // namespace gnomon
