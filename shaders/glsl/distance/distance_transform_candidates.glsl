// Lists the tiles that a site may be within the radius of: the distance between the tile and the sites of every column of tiles,
// from below. A workgroup has the rows of a word, which are those of two tiles.
#include "distance/distance_transform_column.glsl"
#include "distance/distance_transform_bounded.glsl"
#include "lib/tiles.glsl"

layout(local_size_x = 128) in;  // so many that the largest radius in the widest image takes fewer iterations than software devices allow

const int PER_WORD = WORD / TILE;  // 2
const int MOST_ACROSS = 1024;      // tiles across the largest image

shared int gaps[PER_WORD * MOST_ACROSS];  // rows between a tile and the nearest sites of its columns; a row of tiles after another

// Of both tiles of column `tile_x` of tiles: 0 when the tile holds a site itself.
void find_gaps(int tile_x, int word, int layer) {
  int width = imageSize(words).x;
  uint bits = 0u;
  int above = NONE_ABOVE, below = NONE_BELOW;
  for (int i = 0; i < TILE; ++i) {
    Column column = load_column(min(tile_x * TILE + i, width - 1), word, layer);
    bits |= column.bits;
    above = max(above, carry_above(column.carry));
    below = min(below, carry_below(column.carry));
  }
  // In rows from the word's first one: the nearest sites outside of the word, and the first and the last one from its tiles.
  above -= word * WORD, below -= word * WORD;
  int first = bits != 0u ? findLSB(bits) : below, last = bits != 0u ? findMSB(bits) : above;
  gaps[tile_x] = min(-above, max(first - (TILE - 1), 0));
  gaps[MOST_ACROSS + tile_x] = min(below - (WORD - 1), max(TILE - last, 0));
}

// Pixels between two tiles of one row.
int gap_of(int tiles_apart) { return tiles_apart == 0 ? 0 : (tiles_apart - 1) * TILE + 1; }

bool in_reach(int row, int tile_x, int across, int radius) {
  int most = (radius + TILE - 1) / TILE;
  for (int x = max(tile_x - most, 0); x <= min(tile_x + most, across - 1); ++x) {
    int gap = gaps[row * MOST_ACROSS + x];
    if (gap <= radius && square(gap) + square(gap_of(abs(x - tile_x))) <= square(radius)) return true;
  }
  return false;
}

// The workgroups of the search that the frame's radius asks for; of the other, there are none.
void finish(int radius) {
  memoryBarrierBuffer();
  if (!is_last(atomicAdd(candidate_arguments[LISTED_BY], 1u))) return;
  int search = radius > MOST_NEAR_RADIUS ? FAR_SEARCH : NEAR_SEARCH;
  uvec3 groups = tile_workgroups(atomicAdd(candidate_arguments[CANDIDATES], 0u));
  for (int i = 0; i < 3; ++i) candidate_arguments[search + i] = groups[i];
}

void main() {
  ivec2 across = (imageSize(nearest).xy + TILE - 1) / TILE;
  int first = int(gl_LocalInvocationID.x), step = int(gl_WorkGroupSize.x);
  int word = int(gl_WorkGroupID.x), layer = int(gl_WorkGroupID.y);
  for (int x = first; x < across.x; x += step) find_gaps(x, word, layer);
  barrier();
  int radius = frame_radius();
  int rows = min(PER_WORD, across.y - word * PER_WORD);
  for (int i = first; i < rows * across.x; i += step) {
    int row = i / across.x, x = i % across.x;
    if (KEEP_ALL == 1 || in_reach(row, x, across.x, radius))
      candidates[atomicAdd(candidate_arguments[CANDIDATES], 1u)] = pack_tile(ivec2(x, word * PER_WORD + row), layer);
  }
  barrier();
  if (first == 0) finish(radius);
}
