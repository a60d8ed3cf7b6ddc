// Lists every tile.
#include "lib/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant) uniform Push { ivec2 size; } push;  // pixels

void main() {
  ivec2 tile = ivec2(gl_GlobalInvocationID.xy), across = (push.size + TILE - 1) / TILE;
  int layer = int(gl_WorkGroupID.z);
  if (any(greaterThanEqual(tile, across))) return;
  tiles[(layer * across.y + tile.y) * across.x + tile.x] = pack_tile(tile, layer);
}
