// Separable filters: the strips along x whose result a listed strip along y reads.
#include "screen/strip_filter.glsl"

layout(local_size_x = 64) in;

// Do the filters along y read what is in the cell?
bool is_read(ivec2 cell, ivec2 cells, int light) {
  ivec2 others = strips_along_y(cells);
  int first = max(cell.y - cells_around(), 0), last = min(cell.y + cells_around(), cells.y - 1);
  bool read = false;
  for (int y = first / STRIP; y <= last / STRIP; ++y) {
    uint needed = needed_y[(light * others.y + y) * others.x + cell.x];
    int begin = max(first - y * STRIP, 0), end = min(last - y * STRIP, STRIP - 1) + 1;  // of the strip's cells
    read = read || (needed & (1u << end) - (1u << begin)) != 0u;
  }
  return read;
}

void main() {
  ivec2 cells = cells_of(image_size()), strips = strips_along_x(cells);
  int index = int(gl_GlobalInvocationID.x), light = int(gl_GlobalInvocationID.z);
  if (index >= strips.x * strips.y) return;
  ivec2 strip = ivec2(index % strips.x, index / strips.x);
  uint needed = 0u;
  for (int i = 0; i < STRIP; ++i) {
    ivec2 cell = ivec2(strip.x * STRIP + i, strip.y);
    if (cell.x < cells.x && is_read(cell, cells, light)) needed |= 1u << i;
  }
  needed_x[light * strips.x * strips.y + index] = needed;
  if (needed == 0u) return;
  uint slot = atomicAdd(control[ALONG_X + 3], 1u);
  atomicMax(control[ALONG_X], min(slot + 1u, TILE_ROW));
  atomicMax(control[ALONG_X + 1], slot / TILE_ROW + 1u);
  strips_x[slot] = pack_tile(strip, light);
}
