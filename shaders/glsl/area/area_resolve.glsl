// Visibility map (6.2-6.3): a pixel stays lit or in umbra only while every sample says so and none has it on its silhouette.
// The others, in penumbra, are listed for final rendering. A pixel on a single silhouette counts as penumbra too: (6.4) is
// not 0 or 1 there.
#include "frame/frame.glsl"
#include "area/area_words.glsl"
#include "frame/pixel_list.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Push { uint light; } push;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = ivec2(frame.viewport.xy);
  if (any(greaterThanEqual(at, size))) return;
  uint first = sample_ranges[2u * push.light], count = sample_ranges[2u * push.light + 1u];
  uint lit = 0u, dark = 0u, edges = 0u;
  for (uint i = 0u; i < count; i += 32u) {
    uint used = count - i < 32u ? (1u << (count - i)) - 1u : 0xFFFFFFFFu;
    uint place = word_place((first + i) / 32u, at);
    uint word = lit_words[place];
    lit |= word & used;
    dark |= ~word & used;
    edges |= edge_words[place] & used;
  }
  bool penumbra = edges != 0u || (lit != 0u && dark != 0u);
  float v = lit != 0u ? 1.0 : 0.0;
  imageStore(visibility, ivec3(at, push.light), vec4(v));
  imageStore(labels, ivec3(at, push.light), vec4(penumbra ? 0.5 : v));
  if (penumbra || KEEP_ALL == 1) list_pixel(at, size.x);
}
