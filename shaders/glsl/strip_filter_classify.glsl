// Separable filters: what each cell of the image holds, and how far the widest filter of the frame reaches.
#include "strip_filter.glsl"

layout(local_size_x = 4, local_size_y = 4) in;  // one workgroup a cell, four pixels an invocation

shared uint cell_lit, cell_dark, cell_reach;

void main() {
  bool leader = gl_LocalInvocationIndex == 0u;
  if (leader) cell_lit = cell_dark = cell_reach = 0u;
  barrier();
  ivec2 size = image_size(), cell = ivec2(gl_WorkGroupID.xy), corner = cell * CELL + 2 * ivec2(gl_LocalInvocationID.xy);
  int light = int(gl_WorkGroupID.z);
  float least = 1.0, most = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = min(corner + ivec2(i & 1, i >> 1), size - 1);
    float v = imageLoad(visibility, ivec3(pixel, light)).x;
    least = min(least, v);
    most = max(most, v);
  }
  if (most > 0.0) atomicOr(cell_lit, 1u);
  if (least < 1.0) atomicOr(cell_dark, 1u);
  vec4 depths = textureGather(depth, vec2(min(corner + 1, size - 1)) / vec2(size));
  float reach = 0.0;
  for (int i = 0; i < 4; ++i)
    if (!is_background(depths[i])) reach = max(reach, half_width(view_depth(depths[i])));
  atomicMax(cell_reach, uint(ceil(reach)));
  barrier();
  if (!leader) return;
  bool half_way = least > 0.0 && most < 1.0;
  uint state = half_way || (cell_lit == 1u && cell_dark == 1u) ? CELL_MIXED : cell_lit == 1u ? CELL_LIT : CELL_UMBRA;
  ivec2 cells = cells_of(size);
  cell_states[(light * cells.y + cell.y) * cells.x + cell.x] = state;
  atomicMax(control[REACH], cell_reach);
}
