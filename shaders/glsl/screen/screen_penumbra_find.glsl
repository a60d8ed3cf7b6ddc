// Penumbrae on the screen: which pixels have light and shadow both in their kernel. The others keep what the source says, less what
// their own plane hides of the light.
#include "screen/screen_kernel.glsl"
#include "frame/pixel_list.glsl"

layout(push_constant) uniform Push { int layer; float reach; } push;
layout(local_size_x = 8, local_size_y = 8) in;

// Of the cells that the kernel touches.
bool changes(ivec4 bounds) {
  if (KEEP_ALL == 1) return true;
  ivec4 at = bounds / CELL;
  vec2 range = vec2(1.0, 0.0);
  int y = at.y;
  do {
    int x = at.x;
    do {
      vec2 cell = imageLoad(cells, ivec3(x, y, push.layer)).xy;
      range = vec2(min(range.x, cell.x), max(range.y, cell.y));
    } while (++x <= at.z);
  } while (++y <= at.w);
  return range.x < range.y;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(visibility).xy;
  if (any(greaterThanEqual(at, size))) return;
  float penumbra = width_at(at, push.layer).x, v = source_at(at, push.layer).x;
  Receiving here = receiving_at(at, push.layer);
  if (here.receives) {
    SurfaceKernel kernel = kernel_of(here, push.layer, penumbra);
    v *= share_above(kernel.horizon, kernel.round_light);
    if (penumbra > 0.0 && changes(kernel_bounds(kernel, push.reach))) list_pixel(at, size.x);
  }
  imageStore(visibility, ivec3(at, push.layer), vec4(v));
}
