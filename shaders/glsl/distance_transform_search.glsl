// bounded_exact: the nearest sites of a tile's pixels, from the nearest site of each column around it. An invocation has a row of
// the tile in registers: what a column's site costs to find is shared by all of its pixels. Columns come in the order of their
// distance, until none that is left can be nearer.
#include "distance_transform_radius.glsl"
#include "lib/distance_transform.glsl"
#include "lib/tiles.glsl"

layout(local_size_x = 16) in;  // TILE

const int NO_LIFT = 0x40000000;  // pixels^2: further than any site, and sums still fit

shared uint reached_any;

Tile tile;
int y, word;
ivec4 best[4];   // squared distances of the 16 pixels
uvec4 site[4];

// Without branches, which would cost a copy of all that is in registers.
void try_column(int x) {
  int inside = clamp(x, 0, imageSize(words).x - 1);  // columns beyond the edge find its site again, from further away
  int row = nearest_in_column(imageLoad(words, ivec3(inside, word, tile.layer)).xy, word * WORD, y);
  uint packed = pack_site(ivec2(inside, row));
  int d = inside - tile.origin.x, lift = is_row(row) ? square(row - y) : NO_LIFT;
  // (d - i)^2 = d^2 - 2 d i + i^2
  ivec4 i = ivec4(0, 1, 2, 3);
  ivec4 squared = square(d) + lift - 2 * d * i + i * i;
  for (int k = 0; k < 4; ++k) {
    bvec4 nearer = lessThan(squared, best[k]);
    best[k] = min(best[k], squared);
    site[k] = mix(site[k], uvec4(packed), nearer);
    // (d - i - 4)^2 = (d - i)^2 - 8 (d - i) + 16
    squared += 16 - 8 * d + 8 * i;
    i += 4;
  }
}

int farthest() {
  ivec4 most = max(max(best[0], best[1]), max(best[2], best[3]));
  return max(max(most.x, most.y), max(most.z, most.w));
}

void main() {
  uint index = tile_index(gl_WorkGroupID);
  if (index >= candidate_arguments[3]) return;
  if (gl_LocalInvocationID.x == 0u) reached_any = 0u;
  barrier();
  tile = unpack_tile(candidates[index]);
  ivec2 size = imageSize(nearest).xy;
  y = tile.origin.y + int(gl_LocalInvocationID.x);
  word = tile.origin.y / WORD;
  int radius = frame_radius();
  for (int k = 0; k < 4; ++k) {
    best[k] = ivec4(square(radius) + 1);
    site[k] = uvec4(NO_SITE);
  }
  // From the middle of the tile to both sides, two columns at a time on each; the first columns outside are 1 pixel away.
  const int HALF = TILE / 2;
  for (int j = 0; j < HALF + radius && (j < HALF || square(j - HALF + 1) < farthest()); j += 2)
    for (int i = 0; i < 2; ++i) {
      try_column(tile.origin.x + HALF - 1 - j - i);
      try_column(tile.origin.x + HALF + j + i);
    }
  bool found_any = false;
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 4; ++i) {
      ivec2 at = ivec2(tile.origin.x + 4 * k + i, y);
      if (any(greaterThanEqual(at, size))) continue;
      imageStore(nearest, ivec3(at, tile.layer), uvec4(site[k][i]));
      found_any = found_any || site[k][i] != NO_SITE;
    }
  if (found_any || KEEP_ALL == 1) atomicOr(reached_any, 1u);
  barrier();
  if (gl_LocalInvocationID.x == 0u && reached_any != 0u) tiles[atomicAdd(arguments[3], 1u)] = candidates[index];
}
