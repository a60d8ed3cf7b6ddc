// The technique and setting that a budget of time or error asks for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/run/row.h"

namespace gnomon {

struct PickRule {
  std::optional<double>
      max_ms;  // the upper end of the 95 % interval of the frame's median must not exceed it
  std::optional<double> max_error;  // by `metric`
  std::string metric = "rmse";      // one of error_metrics()
};

// Index of the row that wins: with max_ms the least error, else the least median time, among the rows that
// keep the bounds; of equal ones the better in the other figure, then the first. None keeps them: nothing.
std::optional<size_t> pick_row(const std::vector<Row>& rows, const PickRule& rule);

}  // namespace gnomon
