// Penumbrae on the screen: what each cell of the image holds of light and shadow.
#include "frame/frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec3 cell = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(cell.xy, imageSize(cells).xy))) return;
  ivec2 last = textureSize(source, 0).xy - 1;
  vec2 range = vec2(1.0, 0.0);
  for (int i = 0; i < CELL * CELL; ++i) {
    float v = source_at(min(cell.xy * CELL + ivec2(i % CELL, i / CELL), last), cell.z).x;
    range = vec2(min(range.x, v), max(range.y, v));
  }
  imageStore(cells, cell, vec4(range, 0.0, 0.0));
}
