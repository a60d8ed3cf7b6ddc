// How many groups of `b` hold `a`.
#pragma once

#include <cstdint>

namespace gnomon {

constexpr uint32_t divide_up(uint32_t a, uint32_t b) { return (a + b - 1) / b; }

}  // namespace gnomon
