// bounded_exact: the nearest sites of a tile's pixels, from the nearest site of each column around it. An invocation has a row of
// the tile in registers: what a column's site costs to find is shared by all of its pixels. Columns come in the order of their
// distance, until none that is left can be nearer; the invocations of a subgroup load one each and hand them to the others.
#include "distance/distance_transform_column.glsl"
#include "distance/distance_transform_bounded.glsl"
#include "lib/tiles.glsl"

layout(local_size_x = 16) in;  // TILE
#include "lib/subgroup.glsl"

const int HALF = TILE / 2;
const int SIDE = int(min(SUBGROUP_INVOCATIONS, 8u)) / 2;  // columns tried at a time, of each side

shared uint reached_any;

Tile tile;
int y, word;

#if FAR_SITES

ivec4 best[4];  // squared distances of the 16 pixels
uvec4 site[4];

void begin(int radius) {
  for (int k = 0; k < 4; ++k) {
    best[k] = ivec4(square(radius) + 1);
    site[k] = uvec4(NO_SITE);
  }
}

// `d`: from the tile's first column. Without branches, which would cost a copy of all that is in registers.
void try_column(int d, Column column) {
  const int NO_LIFT = 0x40000000;  // pixels^2: further than any site, and sums still fit
  int row = nearest_in_column(column, word * WORD, y);
  uint packed = pack_site(ivec2(tile.origin.x + d, row));
  int lift = is_row(row) ? square(row - y) : NO_LIFT;
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

int squared_of(int pixel) { return best[pixel / 4][pixel % 4]; }
uint site_of(int pixel) { return site[pixel / 4][pixel % 4]; }

#else

// The best of a pixel in one number, so that the least is the nearest: squared distance, column of the site, and whether that is
// above.
const int COLUMN_BITS = 11, COLUMN_BIAS = 1 << (COLUMN_BITS - 1), SITE_BITS = COLUMN_BITS + 1;
const int FAR_LIFT = 1 << 19;  // pixels^2: beyond MOST_NEAR_RADIUS, and sums still fit
uint best[TILE];
uint none;  // more than any within the radius

void begin(int radius) {
  none = uint(square(radius) + 1) << SITE_BITS;
  for (int i = 0; i < TILE; ++i) best[i] = none;
}

// `d`: from the tile's first column.
void try_column(int d, Column column) {
  int up = y - nearest_in_column(column, word * WORD, y);
  uint squared = uint(square(d) + min(square(up), FAR_LIFT)) << SITE_BITS;
  uint candidate = squared | uint(d + COLUMN_BIAS) << 1 | uint(up > 0);
  // (d - i - 1)^2 = (d - i)^2 + 1 - 2 (d - i)
  uint step = uint(1 - 2 * d) << SITE_BITS;
  for (int i = 0; i < TILE; ++i) {
    best[i] = min(best[i], candidate);
    candidate += step;
    step += 2u << SITE_BITS;
  }
}

int squared_of(int pixel) { return int(best[pixel] >> SITE_BITS); }

uint site_of(int pixel) {
  if (best[pixel] >= none) return NO_SITE;
  int d = int(best[pixel] >> 1 & ((1u << COLUMN_BITS) - 1u)) - COLUMN_BIAS;
  int rows = int(round(sqrt(float(squared_of(pixel) - square(d - pixel)))));  // squares below 2^20 have exact roots
  return pack_site(ivec2(tile.origin.x + d, (best[pixel] & 1u) != 0u ? y - rows : y + rows));
}

#endif

int farthest() {
  int most = 0;
  for (int i = 0; i < TILE; ++i) most = max(most, squared_of(i));
  return most;
}

// The i-th column, from the tile's first, of those that are tried once `j` have been on each side of the tile's middle.
int column_of(int i, int j) { return i < SIDE ? HALF - 1 - j - i : HALF + j + i - SIDE; }

// From the middle of the tile to both sides; the first columns outside are 1 pixel away.
void search(int radius) {
  int width = imageSize(words).x, own = int(gl_SubgroupInvocationID) % (2 * SIDE);
  for (int j = 0; j < HALF + radius && any_of_subgroup(j < HALF || square(j - HALF + 1) < farthest()); j += SIDE) {
    int x = tile.origin.x + column_of(own, j);
    Column mine = load_column(clamp(x, 0, width - 1), word, tile.layer);
    if (x < 0 || x >= width) mine = EMPTY_COLUMN;
    for (int i = 0; i < 2 * SIDE; ++i) {
      Column column = Column(subgroupShuffle(mine.bits, i), subgroupShuffle(mine.carry, i));
      try_column(column_of(i, j), column);
    }
  }
}

void finish() {
  memoryBarrierBuffer();
  if (!is_last(atomicAdd(candidate_arguments[SEARCHED_BY], 1u))) return;
  uvec3 groups = tile_workgroups(atomicAdd(arguments[3], 0u));
  for (int i = 0; i < 3; ++i) arguments[i] = groups[i];
}

void main() {
  uint index = tile_index(gl_WorkGroupID, gl_NumWorkGroups);
  if (index >= candidate_arguments[CANDIDATES]) {
    if (gl_LocalInvocationID.x == 0u) finish();
    return;
  }
  if (gl_LocalInvocationID.x == 0u) reached_any = 0u;
  barrier();
  tile = unpack_tile(candidates[index]);
  ivec2 size = imageSize(nearest).xy;
  y = tile.origin.y + int(gl_LocalInvocationID.x);
  word = tile.origin.y / WORD;
  int radius = frame_radius();
  begin(radius);
  search(radius);
  bool found_any = false;
  for (int i = 0; i < TILE; ++i) {
    ivec2 at = ivec2(tile.origin.x + i, y);
    uint nearest_site = site_of(i);
    imageStore(nearest, ivec3(at, tile.layer), uvec4(nearest_site));  // of no effect beyond the image
    found_any = found_any || (nearest_site != NO_SITE && all(lessThan(at, size)));
  }
  if (found_any || KEEP_ALL == 1) atomicOr(reached_any, 1u);
  barrier();
  if (gl_LocalInvocationID.x != 0u) return;
  if (reached_any != 0u) tiles[atomicAdd(arguments[3], 1u)] = candidates[index];
  finish();
}
