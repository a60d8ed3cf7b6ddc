// Plans that need more memory than there may be, refused before anything is allocated.
#pragma once

#include <cstdint>

#include "engine/plan/compile.h"

namespace gnomon {

// Bytes of device memory that a plan's images and buffers take: of its heap, and of what has memory of its
// own.
uint64_t memory_of(const Plan& plan);

// Error, with what takes how much: the graph needs more than Setting::memory. Passes that divide their work
// by that limit may fill it whole, beside what else there is: what counts is the least that they can do with.
// `plan`: of the same graph, setting, facts and options.
void check_memory(const Plan& plan, const Graph& graph, const Declaration::Setting& setting,
                  const SceneFacts& facts, const CompileOptions& options);

}  // namespace gnomon
