// Separable filters: the strips along y that hold, or reach, a change of visibility.
#include "strip_filter.glsl"

layout(local_size_x = 64) in;

void main() {
  ivec2 cells = cells_of(image_size()), strips = strips_along_y(cells);
  int index = int(gl_GlobalInvocationID.x), light = int(gl_GlobalInvocationID.z);
  if (index >= strips.x * strips.y) return;
  ivec2 strip = ivec2(index % strips.x, index / strips.x);
  int around = int(control[REACH]) / CELL + 1;  // cells that one pixel more than the reach touches
  ivec2 first = max(ivec2(strip.x - around, strip.y * STRIP - around), ivec2(0));
  ivec2 last = min(ivec2(strip.x + around, strip.y * STRIP + STRIP - 1 + around), cells - 1);
  uint seen = 0u;  // a bit for each state
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) seen |= 1u << cell_states[(light * cells.y + y) * cells.x + x];
  bool needed = seen != 1u << CELL_UMBRA && seen != 1u << CELL_LIT;
  strip_flags[light * strips.x * strips.y + index] = needed ? 1u : 0u;
  if (!needed) return;
  uint slot = atomicAdd(control[ALONG_Y + 3], 1u);
  atomicMax(control[ALONG_Y], min(slot + 1u, TILE_ROW));
  atomicMax(control[ALONG_Y + 1], slot / TILE_ROW + 1u);
  strips_y[slot] = pack_tile(strip, light);
}
