// Final rendering (6.4) of the listed pixels, those in penumbra.
#include "frame/frame.glsl"
#include "area/area_words.glsl"
#include "frame/pixel_list.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint light; } push;

void main() {
  ivec2 at;
  if (!listed_pixel(list_slot(), int(frame.viewport.x), at)) return;
  uint first = sample_ranges[2u * push.light], count = sample_ranges[2u * push.light + 1u];
  float sum = 0.0;
  for (uint i = 0u; i < count; i += 32u) {
    uint place = word_place((first + i) / 32u, at);
    uint lit = lit_words[place], edges = edge_words[place];
    uint used = min(count - i, 32u);
    for (uint k = 0u; k < used; ++k) sum += float((lit & ~edges) >> k & 1u) * weights[first + i + k];
    uint left = used < 32u ? edges & ((1u << used) - 1u) : edges;
    while (left != 0u) {
      uint k = uint(findLSB(left));
      left &= left - 1u;
      sum += imageLoad(values, ivec3(at, first + i + k)).x * weights[first + i + k];
    }
  }
  imageStore(visibility, ivec3(at, push.light), vec4(clamp(sum, 0.0, 1.0)));
}
