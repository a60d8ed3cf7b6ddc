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

const int AROUND = ROWS + 2;  // rows, with the one above and the one below

// `bits` << `shift`, to the right when that is negative.
uint shifted(uint bits, int shift) { return shift >= 0 ? bits << shift : bits >> -shift; }

// Sets the bits of the pixels whose 3x3 window holds a difference inside column `x`, or between it and the column before.
void add_differences(int x, float column[AROUND], float before[AROUND], inout uint sites[ROWS]) {
  uint beside = shifted(7u, x - 1), between = shifted(3u, x - 1);  // pixels whose windows hold the column, and both columns
  for (int r = 0; r < ROWS; ++r) {
    bool across = column[r] != column[r + 1] || column[r + 1] != column[r + 2];
    bool along = column[r] != before[r] || column[r + 1] != before[r + 1] || column[r + 2] != before[r + 2];
    sites[r] |= (across ? beside : 0u) | (along ? between : 0u);
  }
}

// Macedo 2018, ch. 4.2.2: pixels that differ from one of their eight neighbours. A window of 3x3 pixels is of one value when all
// horizontal and vertical neighbours in it are equal.
void find_sites(ivec2 at, out uint sites[ROWS]) {
  float before[AROUND];
  for (int r = 0; r < AROUND; ++r) before[r] = 0.0;  // of no effect: both columns are outside of every window
  for (int r = 0; r < ROWS; ++r) sites[r] = 0u;
  for (int x = -1; x < WORD; x += 2) {
    float left[AROUND], right[AROUND];
    for (int r = 0; r < AROUND; r += 2) {
      vec4 values = around(at + ivec2(x + 1, r));
      left[r] = values.w, right[r] = values.z;
      left[r + 1] = values.x, right[r + 1] = values.y;
    }
    add_differences(x, left, before, sites);
    add_differences(x + 1, right, left, sites);
    before = right;
  }
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
