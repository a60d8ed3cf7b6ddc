// Separable filters: what the cells of the tiles hold outside of which visibility is plain, and how far the widest filter among
// them reaches. One workgroup a tile.
#include "screen/strip_filter.glsl"

layout(local_size_x = 8, local_size_y = 8) in;  // four pixels an invocation

void main() {
  uint index = tile_index(gl_WorkGroupID, gl_NumWorkGroups);
  if (index >= arguments[3]) return;
  Tile tile = unpack_tile(tiles[index]);
  ivec2 size = image_size(), cells = cells_of(size), corner = tile.origin + 2 * ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(corner, size))) return;
  uint content = 0u;
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = min(corner + ivec2(i % 2, i / 2), size - 1);
    content |= content_of(imageLoad(visibility, ivec3(pixel, tile.layer)).x);
  }
  atomicOr(cell_states[(tile.layer * cells.y + corner.y / CELL) * cells.x + corner.x / CELL], content);
  float reach = 0.0;
#ifdef HAS_WIDTH
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = min(corner + ivec2(i % 2, i / 2), size - 1);
    float device_depth = depth_at(pixel).x;
    if (!is_background(device_depth)) reach = max(reach, half_width(pixel, tile.layer, image_depth(device_depth)));
  }
#else
  vec4 depths = textureGather(depth, vec2(min(corner + 1, size - 1)) / vec2(size));
  for (int k = 0; k < 4; ++k)
    if (!is_background(depths[k])) reach = max(reach, half_width(image_depth(depths[k])));
#endif
  atomicMax(control[REACH], uint(ceil(reach)));
}
