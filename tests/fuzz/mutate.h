// Mutations that keep an input's form, so that what lies behind its parser is reached.
#pragma once

#include <cstddef>
#include <string>

#include "tests/fuzz/target.h"

namespace gnomon::fuzz {

// Bytes without form, and the most of them.
using MutateBytes = std::string (*)(std::string bytes, size_t most);

// May be larger than `most`. The same seed, the same mutation.
std::string mutated(Kind kind, const std::string& bytes, size_t most, unsigned seed, MutateBytes formless);

}  // namespace gnomon::fuzz
