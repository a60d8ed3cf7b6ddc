// Sites as bits, 32 rows a word (lib/distance_transform.glsl): everything after reads 1/32 of what the image holds. An invocation
// makes a word of each of four columns from gathers, each of which reads 2x2 pixels at once.
#include "lib/distance_transform.glsl"

layout(local_size_x = 32) in;

layout(push_constant) uniform Push { ivec2 size; int layer; } push;  // of the image; of a constant, `source` has one texel

const int COLUMNS = 4;

// Four pixels around the corner at `corner`: x left below, y right below, z right above, w left above. Beyond the image its edge
// is repeated.
vec4 around(ivec2 corner, int layer) {
  return textureGather(source, vec3(vec2(corner) / vec2(push.size), layer));
}

#if SITES == SITES_NONZERO

uvec4 find_sites(ivec2 at, int layer) {
  uvec4 bits = uvec4(0u);
  for (int row = 0; row < WORD; row += 2) {
    vec4 a = around(at + ivec2(1, row + 1), layer), b = around(at + ivec2(3, row + 1), layer);
    uvec4 upper = uvec4(notEqual(vec4(a.wz, b.wz), vec4(0.0))), lower = uvec4(notEqual(vec4(a.xy, b.xy), vec4(0.0)));
    bits |= (upper | lower << 1) << row;
  }
  return bits;
}

#else

// A row of six pixels: the four columns and one on either side.
struct Row {
  vec4 left, centre, right;  // of each of the four columns
};

Row make_row(vec2 a, vec2 b, vec2 c) {
  Row row;
  row.left = vec4(a, b);
  row.centre = vec4(a.y, b, c.x);
  row.right = vec4(b, c);
  return row;
}

// `bits` << `shift`, to the right when that is negative.
uint shifted(uint bits, int shift) { return shift >= 0 ? bits << shift : bits >> -shift; }

// Sets the bits of the pixels whose 3x3 window holds a difference between neighbours of row `y`, or between those of that row and
// of the one before.
void add_differences(Row before, Row row, int y, inout uvec4 bits) {
  uvec4 along = uvec4(notEqual(row.left, row.centre)) | uvec4(notEqual(row.centre, row.right));
  uvec4 across = uvec4(notEqual(before.left, row.left)) | uvec4(notEqual(before.centre, row.centre)) |
                 uvec4(notEqual(before.right, row.right));
  bits |= along * shifted(7u, y - 1) | across * shifted(3u, y - 1);
}

// Macedo 2018, ch. 4.2.2: pixels that differ from one of their eight neighbours. A window of 3x3 pixels is of one value when all
// horizontal and vertical neighbours in it are equal.
uvec4 find_sites(ivec2 at, int layer) {
  uvec4 bits = uvec4(0u);
  Row before;
  for (int y = -1; y < WORD; y += 2) {
    ivec2 corner = at + ivec2(0, y + 1);
    vec4 a = around(corner, layer), b = around(corner + ivec2(2, 0), layer), c = around(corner + ivec2(4, 0), layer);
    Row upper = make_row(a.wz, b.wz, c.wz), lower = make_row(a.xy, b.xy, c.xy);
    if (y < 0) before = upper;  // the row above it is outside of every window
    add_differences(before, upper, y, bits);
    add_differences(upper, lower, y + 1, bits);
    before = lower;
  }
  return bits;
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
  int word = int(gl_WorkGroupID.y), layer = push.layer;
  ivec2 at = ivec2(int(gl_GlobalInvocationID.x) * COLUMNS, word * WORD);
  ivec2 size = push.size;
  if (at.x >= size.x) return;
  uvec4 bits = find_sites(at, layer);
  int rows = size.y - at.y;
  if (rows < WORD) bits &= (1u << rows) - 1u;
  for (int i = 0; i < COLUMNS; ++i) {
    if (at.x + i >= size.x) break;
#if LISTED
    list(bits[i], at + ivec2(i, 0));
    imageStore(words, ivec3(at.x + i, word, layer), uvec4(0u));
#else
    imageStore(words, ivec3(at.x + i, word, layer), uvec4(bits[i]));
#endif
  }
}
