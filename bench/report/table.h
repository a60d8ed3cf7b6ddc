// Rows of results.jsonl as a table to read.
#pragma once

#include <string>
#include <vector>

#include "bench/run/row.h"

namespace gnomon {

// One table per scene and size (technique, misclassified, wrongly lit, wrongly shadowed, acne, RMSE, for
// sequences mean RMSE and flicker, ms, ratio) and, for more than one scene, the means over the scenes in
// which a technique ran. Shares are in per cent of the counted pixels; ms is the median frame; ratio is to
// the suite's baseline. "-" where there is no figure; a row that failed shows its status instead. Variables
// that are the same in every row of a technique are not shown.
std::string to_table(const std::vector<Row>& rows);

}  // namespace gnomon
