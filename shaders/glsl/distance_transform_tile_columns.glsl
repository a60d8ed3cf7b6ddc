// For every tile, the rows between it and the nearest site of the same column of tiles: 0 when the tile holds one itself.
#include "lib/distance_transform.glsl"
#include "lib/tiles.glsl"

layout(local_size_x = 8) in;

const int FAR = 0x8000;  // rows: more than any image has

// Sites of the tile column in a word's rows.
uint any_sites(int tile_x, int word, int layer) {
  uint bits = 0u;
  int width = imageSize(words).x;
  for (int i = 0; i < TILE; ++i)
    bits |= imageLoad(words, ivec3(min(tile_x * TILE + i, width - 1), word, layer)).x;
  return bits;
}

void main() {
  ivec2 across = (imageSize(nearest).xy + TILE - 1) / TILE;
  int tile_x = int(gl_GlobalInvocationID.x), layer = int(gl_WorkGroupID.y);
  if (tile_x >= across.x) return;
  const int PER_WORD = WORD / TILE;
  int base = layer * across.x * across.y + tile_x;
  int last = -FAR;  // row of the last site above
  for (int tile_y = 0; tile_y < across.y; ++tile_y) {
    uint bits = any_sites(tile_x, tile_y / PER_WORD, layer) >> (tile_y % PER_WORD * TILE) & 0xFFFFu;
    tile_gaps[base + tile_y * across.x] = bits != 0u ? 0 : min(tile_y * TILE - last, FAR);
    if (bits != 0u) last = tile_y * TILE + findMSB(bits);
  }
  int next = 2 * FAR;  // row of the first site below
  for (int tile_y = across.y - 1; tile_y >= 0; --tile_y) {
    uint bits = any_sites(tile_x, tile_y / PER_WORD, layer) >> (tile_y % PER_WORD * TILE) & 0xFFFFu;
    int i = base + tile_y * across.x;
    tile_gaps[i] = min(tile_gaps[i], next - (tile_y * TILE + TILE - 1));
    if (bits != 0u) next = tile_y * TILE + findLSB(bits);
  }
}
