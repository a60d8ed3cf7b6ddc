// Which of the files that a row names as images a report may show.
#include "bench/report/report_image_files.h"

namespace gnomon {

namespace fs = std::filesystem;

std::optional<fs::path> image_below(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
  if (error) return std::nullopt;
  fs::path file = fs::canonical(root / name, error);
  if (error || !fs::is_regular_file(file, error)) return std::nullopt;
  const fs::path inside = file.lexically_relative(root);
  if (inside.empty() || *inside.begin() == "..") return std::nullopt;
  return file;
}

}  // namespace gnomon
