// Matrices of 32x32 bits that the invocations of a subgroup hold together. Pure functions.
#ifndef GNOMON_BIT_MATRIX
#define GNOMON_BIT_MATRIX

#include "subgroup.glsl"

const uint MATRIX_SIDE = 32u;
const uint MATRIX_INVOCATIONS = min(SUBGROUP_INVOCATIONS, 16u);  // that share a matrix: neighbours in the subgroup
const uint MATRIX_ROWS = MATRIX_SIDE / MATRIX_INVOCATIONS;       // rows of an invocation, from row MATRIX_ROWS * matrix_part()

uint matrix_part() { return gl_SubgroupInvocationID % MATRIX_INVOCATIONS; }

// Exchanges row and column: bit j of row i becomes bit i of row j. By halves, quarters, and so on: of a pair of rows `d` apart, the
// upper bits of the first and the lower ones of the second, in groups of `d`, change places.
void transpose(inout uint rows[MATRIX_ROWS]) {
  uint lower = 0x0000FFFFu;  // of each two groups of d bits
  for (int i = 1; i <= 5; ++i) {  // counted in steps of one, so that compilers unroll it
    uint d = MATRIX_SIDE >> i;
    for (uint r = 0u; r < MATRIX_ROWS; ++r) {
      if (d >= MATRIX_ROWS) {
        uint apart = d / MATRIX_ROWS;
        uint other = subgroupShuffleXor(rows[r], apart);
        bool is_first = (matrix_part() & apart) == 0u;
        rows[r] = is_first ? (rows[r] & lower) | (other & lower) << d : (rows[r] & ~lower) | (other & ~lower) >> d;
      } else if ((r & d) == 0u) {
        uint first = rows[r], second = rows[r + d];
        rows[r] = (first & lower) | (second & lower) << d;
        rows[r + d] = (second & ~lower) | (first & ~lower) >> d;
      }
    }
    lower ^= lower << (d / 2u);
  }
}

#endif
