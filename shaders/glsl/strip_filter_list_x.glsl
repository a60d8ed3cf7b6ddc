// Separable filters: the strips along x whose result a listed strip along y reads.
#include "strip_filter.glsl"

layout(local_size_x = 64) in;

void main() {
  ivec2 cells = cells_of(image_size()), strips = strips_along_x(cells), others = strips_along_y(cells);
  int index = int(gl_GlobalInvocationID.x), light = int(gl_GlobalInvocationID.z);
  if (index >= strips.x * strips.y) return;
  ivec2 strip = ivec2(index % strips.x, index / strips.x);
  int around = int(control[REACH]) / CELL + 1;  // cells that one pixel more than the reach touches
  ivec2 first = ivec2(strip.x * STRIP, max(strip.y - around, 0) / STRIP);
  ivec2 last = ivec2(min(strip.x * STRIP + STRIP, cells.x) - 1, min(strip.y + around, cells.y - 1) / STRIP);
  bool needed = false;
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x)
      needed = needed || strip_flags[light * others.x * others.y + y * others.x + x] == 1u;
  if (!needed) return;
  uint slot = atomicAdd(control[ALONG_X + 3], 1u);
  atomicMax(control[ALONG_X], min(slot + 1u, TILE_ROW));
  atomicMax(control[ALONG_X + 1], slot / TILE_ROW + 1u);
  strips_x[slot] = pack_tile(strip, light);
}
