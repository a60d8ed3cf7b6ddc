// Appends rows to results.jsonl and reads them back.
#include "bench/run/results.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/base/config.h"
#include "engine/base/error.h"
#include "engine/base/input_file.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string read_whole(const fs::path& file) {
  if (std::error_code ignored; !fs::exists(file, ignored))
    fail("cannot open the results", file.string(), {}, "gnomon bench SUITE --out DIR writes them");
  return read_input_file(file);
}

// Everything up to the end of the last whole line.
size_t whole_length(const std::string& text) {
  const size_t last = text.rfind('\n');
  return last == std::string::npos ? 0 : last + 1;
}

struct Numbered {
  json object;
  size_t number = 0;  // from 1
};

std::vector<Numbered> numbered_lines(const fs::path& file) {
  const std::string text = read_whole(file);
  std::istringstream lines(text.substr(0, whole_length(text)));
  std::vector<Numbered> all;
  std::map<std::string, size_t> by_key;
  std::string line;
  for (size_t number = 1; std::getline(lines, line); ++number) {
    if (line.empty()) continue;
    json object = parse_json(line, file.string(), number);
    if (!object.is_object()) fail("not a JSON object", file.string(), fmt::format("line {}", number));
    const auto key = object.find("key");
    const bool named = key != object.end() && key->is_string() && !key->get_ref<const std::string&>().empty();
    const auto known = named ? by_key.find(key->get<std::string>()) : by_key.end();
    if (known != by_key.end()) {
      all[known->second] = {std::move(object), number};
    } else {
      if (named) by_key[key->get<std::string>()] = all.size();
      all.push_back({std::move(object), number});
    }
  }
  return all;
}

}  // namespace

std::vector<json> read_lines(const fs::path& file) {
  std::vector<json> objects;
  for (Numbered& line : numbered_lines(file)) objects.push_back(std::move(line.object));
  return objects;
}

std::vector<Row> read_results(const fs::path& file) {
  std::vector<Row> rows;
  for (const Numbered& line : numbered_lines(file))
    rows.push_back(row_from(line.object, file.string(), fmt::format("line {}", line.number)));
  return rows;
}

ResultsFile::ResultsFile(fs::path file, bool go_on) : file_(std::move(file)) {
  std::error_code error;
  fs::create_directories(file_.parent_path(), error);
  if (error) fail("cannot make the folder: " + error.message(), file_.parent_path().string());
  const bool there = fs::is_regular_file(file_) && fs::file_size(file_) > 0;
  if (there && !go_on)
    fail("there are results already", file_.string(), {},
         "--resume goes on, --overwrite starts anew, --out takes another folder");
  if (there) {
    const std::string text = read_whole(file_);
    if (whole_length(text) != text.size()) fs::resize_file(file_, whole_length(text));
  }
  descriptor_ = open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail(std::string("cannot write: ") + std::strerror(errno), file_.string());
}

ResultsFile::~ResultsFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void ResultsFile::append(const Row& row) { append(to_json(row)); }

void ResultsFile::append(const json& object) {
  const std::string line = object.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
  const off_t before = lseek(descriptor_, 0, SEEK_END);
  size_t written = 0;
  while (written < line.size()) {
    const ssize_t count = write(descriptor_, line.data() + written, line.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const std::string reason = std::strerror(errno);
      if (ftruncate(descriptor_, before) != 0)
        fail("cannot write, and the last line is torn: " + reason, file_.string());
      fail("cannot write: " + reason, file_.string());
    }
    written += static_cast<size_t>(count);
  }
  fsync(descriptor_);
}

}  // namespace gnomon
