// Which of the files that a row names as images a report may show.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace gnomon {

// The image `name` of a run in `folder`: a regular file below the folder once links are followed. Nothing for
// all else: a row may come from anywhere, and a report carries what it shows.
std::optional<std::filesystem::path> image_below(const std::filesystem::path& folder,
                                                 const std::string& name);

}  // namespace gnomon
