// Separable filters: what each cell of the image holds, and how far the widest filter of the frame reaches. One invocation a
// cell: nothing to wait for.
#include "screen/strip_filter.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec2 size = image_size(), cells = cells_of(size), cell = ivec2(gl_GlobalInvocationID.xy);
  int light = int(gl_GlobalInvocationID.z);
  if (any(greaterThanEqual(cell, cells))) return;
  uint content = 0u;
  for (int i = 0; i < CELL * CELL; ++i) {
    ivec2 pixel = min(cell * CELL + ivec2(i % CELL, i / CELL), size - 1);
    content |= content_of(imageLoad(visibility, ivec3(pixel, light)).x);
  }
  float reach = 0.0;
#ifdef HAS_WIDTH
  for (int i = 0; i < CELL * CELL; ++i) {
    ivec2 pixel = min(cell * CELL + ivec2(i % CELL, i / CELL), size - 1);
    float device_depth = depth_at(pixel).x;
    if (!is_background(device_depth)) reach = max(reach, half_width(pixel, light, image_depth(device_depth)));
  }
#else
  for (int i = 0; i < CELL * CELL / 4; ++i) {
    ivec2 corner = cell * CELL + 2 * ivec2(i % (CELL / 2), i / (CELL / 2)) + 1;
    vec4 depths = textureGather(depth, vec2(min(corner, size - 1)) / vec2(size));
    for (int k = 0; k < 4; ++k)
      if (!is_background(depths[k])) reach = max(reach, half_width(image_depth(depths[k])));
  }
#endif
  cell_states[(light * cells.y + cell.y) * cells.x + cell.x] = content;
  atomicMax(control[REACH], uint(ceil(reach)));
}
