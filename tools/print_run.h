// A measurement in words, as `gnomon render` ends with.
#pragma once

#include "bench/run/row.h"

namespace gnomon {

// Times of frame and passes, what was left out, and the error; "-" where there is no figure, with the reason.
void print_run(const Row& row);

}  // namespace gnomon
