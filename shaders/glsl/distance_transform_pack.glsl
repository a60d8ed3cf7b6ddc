// Sites as bits, 32 rows a word (lib/distance_transform.glsl): everything after reads 1/32 of what the image holds. Invocations walk
// along rows, two at a time by gathers, so that a subgroup has loads from many rows under way; each then has rows of a square of
// 32x32 pixels as bits, which are turned into words of columns.
#include "lib/distance_transform.glsl"

layout(local_size_x = 32) in;
#include "lib/bit_matrix.glsl"

layout(push_constant) uniform Push { ivec2 size; int layer; } push;  // of the image; of a constant, `source` has one texel

const int ROWS = int(MATRIX_ROWS);

// Four pixels around the corner at `corner`: x left below, y right below, z right above, w left above. Beyond the image its edge
// is repeated.
vec4 around(ivec2 corner) { return textureGather(source, vec3(vec2(corner) / vec2(push.size), push.layer)); }

#if SITES == SITES_NONZERO

// Rows from pixel `at` on, a bit a pixel.
void find_sites(ivec2 at, out uint sites[ROWS]) {
  for (int r = 0; r < ROWS; ++r) sites[r] = 0u;
  for (int x = 0; x < WORD; x += 2)
    for (int r = 0; r < ROWS; r += 2) {
      uvec4 is_site = uvec4(notEqual(around(at + ivec2(x + 1, r + 1)), vec4(0.0)));
      sites[r] |= (is_site.w | is_site.z << 1) << x;
      sites[r + 1] |= (is_site.x | is_site.y << 1) << x;
    }
}

#else

// Macedo 2018, ch. 4.2.2: pixels that differ from one of their eight neighbours. A window of 3x3 pixels is of one value when all
// horizontal and vertical neighbours in it are equal.
void find_sites(ivec2 at, out uint sites[ROWS]) {
  const int AROUND = ROWS + 2;  // rows, with the one above and the one below
  uint along[AROUND];           // bit i: do pixels x + i - 1 and x + i of this row differ? Bit 32 is in along_last
  uint across[AROUND - 1];      // bit i: do this row's and the next one's pixel x + i differ? Bits -1 and 32 in across_ends
  uint along_last[AROUND], across_ends[AROUND - 1];
  float before[AROUND];         // last pixel that was seen of each row
  for (int r = 0; r < AROUND; ++r) along[r] = along_last[r] = 0u;
  for (int r = 0; r < AROUND - 1; ++r) across[r] = across_ends[r] = 0u;
  for (int x = -1; x < WORD; x += 2) {
    float left[AROUND], right[AROUND];
    for (int r = 0; r < AROUND; r += 2) {
      vec4 square = around(at + ivec2(x + 1, r));
      left[r] = square.w, right[r] = square.z;
      left[r + 1] = square.x, right[r + 1] = square.y;
    }
    bool is_first = x < 0, is_last = x + 1 >= WORD;
    for (int r = 0; r < AROUND; ++r) {
      uint of_left = uint(!is_first && before[r] != left[r]), of_right = uint(left[r] != right[r]);
      along[r] |= is_first ? of_right : of_left << x;
      if (is_last)
        along_last[r] = of_right;
      else if (!is_first)
        along[r] |= of_right << (x + 1);
      before[r] = right[r];
    }
    for (int r = 0; r < AROUND - 1; ++r) {
      uint of_left = uint(left[r] != left[r + 1]), of_right = uint(right[r] != right[r + 1]);
      if (is_first)
        across_ends[r] |= of_left;
      else
        across[r] |= of_left << x;
      if (is_last)
        across_ends[r] |= of_right << (WORD - 1);
      else
        across[r] |= of_right << (x + 1);
    }
  }
  for (int r = 0; r < AROUND; ++r) along[r] |= along[r] >> 1 | along_last[r] << (WORD - 1);
  for (int r = 0; r < AROUND - 1; ++r) across[r] |= across[r] << 1 | across[r] >> 1 | across_ends[r];
  for (int r = 0; r < ROWS; ++r) sites[r] = along[r] | along[r + 1] | along[r + 2] | across[r] | across[r + 1];
}

#endif

// What needs the pixel's depth is left to distance_transform_resolve, for the listed pixels only.
void list(uint bits, ivec2 at) {
#if LISTED
  for (; bits != 0u; bits &= bits - 1u) {
    uint slot = atomicAdd(found_arguments[3], 1u);
    found[slot] = pack_site(at + ivec2(0, findLSB(bits)));
  }
#endif
}

void main() {
  int square = int(gl_WorkGroupID.x * gl_WorkGroupSize.x / MATRIX_INVOCATIONS + gl_LocalInvocationID.x / MATRIX_INVOCATIONS);
  int word = int(gl_WorkGroupID.y);
  ivec2 at = ivec2(square, word) * WORD;
  int part = int(matrix_part()) * ROWS;  // rows, then columns of this invocation
  uint bits[ROWS];
  find_sites(at + ivec2(0, part), bits);
  transpose(bits);
  int rows = push.size.y - at.y;
  for (int i = 0; i < ROWS; ++i) {
    int x = at.x + part + i;
    if (x >= push.size.x) break;
    uint sites = rows < WORD ? bits[i] & (1u << rows) - 1u : bits[i];
    list(sites, ivec2(x, at.y));
    imageStore(words, ivec3(x, word, push.layer), uvec4(LISTED == 1 ? 0u : sites));
  }
}
