// Lists of square tiles of an image, which passes hand to each other so that work follows the pixels that need it. Pure
// functions.
//
// A list is a buffer of packed tiles in no particular order, and a buffer of four arguments: the workgroups (x, y, z) of an
// indirect dispatch of one workgroup a tile, and the number of tiles. Workgroup g of n handles tile number tile_index(g, n), if there
// is one.
//
// Whoever includes this defines TILE, a tile's side in pixels (int).
#ifndef GNOMON_TILES
#define GNOMON_TILES

const uint TILE_ROW = 65535u;  // workgroups along x at most: what every device allows

struct Tile {
  ivec2 origin;  // pixel
  int layer;
};

// `tile`: its place in units of TILE, below 4096; `layer` below 256.
uint pack_tile(ivec2 tile, int layer) { return uint(tile.x) | uint(tile.y) << 12 | uint(layer) << 24; }
Tile unpack_tile(uint packed) {
  Tile tile;
  tile.origin = ivec2(packed & 0xFFFu, packed >> 12 & 0xFFFu) * TILE;
  tile.layer = int(packed >> 24);
  return tile;
}

// Workgroups that take `count` tiles, and hardly any more: software devices spend as much on those that have no tile.
uvec3 tile_workgroups(uint count) {
  uint rows = max((count + TILE_ROW - 1u) / TILE_ROW, 1u);
  return uvec3((count + rows - 1u) / rows, rows, 1u);
}
uint tile_index(uvec3 workgroup, uvec3 workgroups) { return workgroup.x + workgroup.y * workgroups.x; }

#endif
