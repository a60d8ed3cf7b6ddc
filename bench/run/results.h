// results.jsonl: one JSON object per line, appended as it is measured.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "bench/run/row.h"

namespace gnomon {

// All whole lines of a file of JSON objects, in order; a torn last line (an interrupted run) is left out. Of
// rows with the same "key" only the last one is kept, at the place of the first. Error: no such file, or a
// line that is not a JSON object.
std::vector<nlohmann::json> read_lines(const std::filesystem::path& file);
// The same of rows. Error: a line that is no row, too.
std::vector<Row> read_results(const std::filesystem::path& file);

// Appends lines. A line is on disk when append() returns; a line that could not be written whole is taken
// back.
class ResultsFile {
 public:
  // Makes the folder. `go_on`: keeps what is there, less a torn last line; otherwise the file must be new or
  // empty.
  ResultsFile(std::filesystem::path file, bool go_on);
  ~ResultsFile();
  ResultsFile(const ResultsFile&) = delete;
  ResultsFile& operator=(const ResultsFile&) = delete;

  void append(const nlohmann::json& object);  // Error: full disk, ...
  void append(const Row& row);                // Error: full disk, ...
  const std::filesystem::path& path() const { return file_; }

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace gnomon
