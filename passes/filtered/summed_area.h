// What a summed-area table says of itself, and how its readers take it.
#pragma once

#include <string>

#include "engine/base/params.h"
#include "engine/base/shape.h"
#include "engine/graph/pass.h"
#include "engine/vulkan/shader.h"

namespace gnomon {

// Of a table. Integers are of 32 bits and wrap; of a pair the second holds what the first, cut off, leaves.
enum class TableNumbers { integer, integer_pair, floating };

// Of the pass that makes a table of `source`: parameters `numbers`, `largest_kernel`, `least`, `greatest`.
TableNumbers declare_table(Declaration& d, const std::string& source);
// ... and, once it is declared, what the output that has them says of itself.
void set_table(Declaration& d, const std::string& output);

// Of a reader: `numbers`, `largest_kernel`, `least`, `greatest` as derived values. `wanted`: anything but a
// table is refused; otherwise a table is.
void read_table(Declaration& d, const std::string& input, bool wanted);

// Steps of an integer table between `least` and `greatest`: the sum over the largest kernel is below 2^32.
uint32_t table_steps(const Params& params);

// Of a reader: TABLE_STEPS, as a float; TABLE_INTEGER, 1 when the table's numbers are integers.
Defines table_defines(const ImageShape& table, const Params& params);

}  // namespace gnomon
