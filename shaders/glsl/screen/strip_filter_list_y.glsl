// Separable filters: the strips along y that hold, or reach, a change of visibility.
#include "screen/strip_filter.glsl"

layout(local_size_x = 64) in;

void main() {
  ivec2 cells = cells_of(image_size()), strips = strips_along_y(cells);
  int index = int(gl_GlobalInvocationID.x), light = int(gl_GlobalInvocationID.z);
  if (index >= strips.x * strips.y) return;
  ivec2 strip = ivec2(index % strips.x, index / strips.x);
  int around = cells_around();
  uint needed = 0u;
  for (int i = 0; i < STRIP; ++i) {
    ivec2 cell = ivec2(strip.x, strip.y * STRIP + i);
    if (cell.y < cells.y && changes(cell - around, cell + around, light)) needed |= 1u << i;
  }
  needed_y[light * strips.x * strips.y + index] = needed;
  if (needed == 0u) return;
  uint slot = atomicAdd(control[ALONG_Y + 3], 1u);
  atomicMax(control[ALONG_Y], min(slot + 1u, TILE_ROW));
  atomicMax(control[ALONG_Y + 1], slot / TILE_ROW + 1u);
  strips_y[slot] = pack_tile(strip, light);
}
