// The text of an Error: a line per problem.
#include "engine/base/error.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace gnomon {
namespace {

std::string join(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += to_string(problem);
  }
  return text;
}

// Levenshtein distance, one row at a time.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

size_t length_difference(std::string_view a, std::string_view b) {
  return a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
}

const std::string* nearest(std::string_view name, std::span<const std::string> candidates) {
  const size_t limit = std::max<size_t>(2, name.size() / 3);
  const std::string* best = nullptr;
  size_t best_distance = limit + 1;
  for (const std::string& candidate : candidates) {
    if (length_difference(name, candidate) >= best_distance) continue;
    const size_t distance = edit_distance(name, candidate);
    // a name all of whose letters differ is no spelling mistake
    if (distance >= std::max(name.size(), candidate.size())) continue;
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = &candidate;
  }
  return best;
}

}  // namespace

std::string to_string(const Problem& problem) {
  std::string text;
  if (!problem.file.empty()) text += problem.file + ": ";
  if (!problem.place.empty()) text += problem.place + ": ";
  text += problem.what;
  if (!problem.hint.empty()) text += " (" + problem.hint + ")";
  return text;
}

Error::Error(Problem problem) : Error(std::vector<Problem>{std::move(problem)}) {}
Error::Error(std::vector<Problem> problems)
    : std::runtime_error(join(problems)), problems_(std::move(problems)) {}

void fail(std::string what, std::string file, std::string place, std::string hint) {
  throw Error(Problem{std::move(what), std::move(file), std::move(place), std::move(hint)});
}

void Problems::add(std::string what, std::string file, std::string place, std::string hint) {
  problems_.push_back({std::move(what), std::move(file), std::move(place), std::move(hint)});
}

void Problems::raise() const {
  if (!problems_.empty()) throw Error(problems_);
}

std::string did_you_mean(std::string_view name, std::span<const std::string> candidates) {
  constexpr size_t most_listed = 12;
  if (const std::string* best = nearest(name, candidates)) return "did you mean '" + *best + "'?";
  if (candidates.empty() || candidates.size() > most_listed) return {};
  std::string text = "one of: ";
  for (size_t i = 0; i < candidates.size(); ++i) text += (i ? ", " : "") + candidates[i];
  return text;
}

}  // namespace gnomon
