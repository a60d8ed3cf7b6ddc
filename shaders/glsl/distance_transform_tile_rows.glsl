// Lists the tiles that a site may be within the radius of: the distance between the tile and the sites of every column of tiles,
// from below.
#include "distance_transform_radius.glsl"
#include "lib/distance_transform.glsl"
#include "lib/tiles.glsl"

layout(local_size_x = 8) in;

// Pixels between two tiles of one row.
int gap_of(int tiles_apart) { return tiles_apart == 0 ? 0 : (tiles_apart - 1) * TILE + 1; }

bool in_reach(ivec2 tile, ivec2 across, int layer) {
  int radius = frame_radius(), most = (radius + TILE - 1) / TILE;
  int row = (layer * across.y + tile.y) * across.x;
  for (int x = max(tile.x - most, 0); x <= min(tile.x + most, across.x - 1); ++x) {
    int gap = tile_gaps[row + x];
    if (gap <= radius && square(gap) + square(gap_of(abs(x - tile.x))) <= square(radius)) return true;
  }
  return false;
}

void main() {
  ivec2 across = (imageSize(nearest).xy + TILE - 1) / TILE;
  ivec2 tile = ivec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y);
  int layer = int(gl_WorkGroupID.z);
  if (tile.x >= across.x || !(KEEP_ALL == 1 || in_reach(tile, across, layer))) return;
  candidates[atomicAdd(candidate_arguments[3], 1u)] = pack_tile(tile, layer);
}
