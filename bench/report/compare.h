// What changed between two runs of a suite.
#pragma once

#include <string>
#include <vector>

#include "bench/run/row.h"

namespace gnomon {

struct Change {
  enum class Kind { time, error, failure, missing } kind = Kind::time;
  std::string where;             // scene, size and technique
  std::string what;              // "ratio", a metric, or a sentence
  double before = 0, after = 0;  // of time: median ratios to the baseline; of error: the metric
  bool worse = false;            // a regression
};

struct Comparison {
  size_t compared = 0;          // rows that both runs have with status ok
  size_t intervals = 0;         // of these, those with a ratio to another row in both runs,
  size_t overlapping = 0;       // and those whose 95 % intervals of the ratio overlap
  std::vector<Change> changes;  // in the order of the new rows; what is missing last
  bool regressed() const;
  // Share of the intervals that overlap; 1 when there are none. Two runs of the same program on the same
  // machine should give 0.95 or more, else the intervals promise too much.
  double overlap() const;
};

// Rows are the same when scene, size, camera, device, reference, sequence length and the graph with all its
// variables are. Time is the ratio to the baseline, which a slow machine does not change: it differs when the
// 95 % intervals do not overlap and the medians differ by more than the share `tolerance`. Errors are the
// same bits on the same device: any difference counts. A row that no longer runs is a regression; one that is
// not in `after` is not.
Comparison compare_results(const std::vector<Row>& before, const std::vector<Row>& after, double tolerance);

// A table of the changes and a line that counts them.
std::string to_table(const Comparison& comparison);

}  // namespace gnomon
