// What a suite measures: its rows, place by place, and which of them are measured in turn.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "bench/run/harness.h"

namespace gnomon {

struct PlaceToMeasure : SuitePlace {
  std::vector<size_t> configs;
  std::set<size_t> finished;  // of these, in the run that this one resumes
  size_t missing() const { return configs.size() - finished.size(); }
};

// Techniques that are measured in turn, with their baseline.
struct Chunk {
  size_t baseline = 0;
  std::vector<size_t> configs;
};

// The row of one technique at one place, without what is measured.
Row planned_row(const Suite& suite, const BenchOptions& options, const SuitePlace& place,
                const SuiteConfig& config);

// The places where this shard has rows; `finished`: keys of rows that need not be measured again.
std::vector<PlaceToMeasure> planned_places(const Suite& suite, const BenchOptions& options,
                                           const std::set<std::string>& finished);

// Techniques with the same baseline are measured together. The baseline itself first, when it is to be
// measured. What is finished counts, so that a resumed suite has the same chunks.
std::vector<Chunk> chunks_of(const Suite& suite, const BenchOptions& options, const PlaceToMeasure& place);

// Of what is measured in turn, in this run or in the one that it resumes.
std::string group_of(const Suite& suite, const BenchOptions& options, const SuitePlace& place,
                     const Chunk& chunk);

// The suite with its scenes found and its sizes spelled out, so that it can be run again from this folder.
nlohmann::json suite_as_run(const Suite& suite);

}  // namespace gnomon
