// From pixels' words to samples' planes: 32 pixels of a row by 32 samples, a bit matrix transposed.
#include "frame/frame.glsl"
#include "area/area_words.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Push { uint word, bit, count; } push;

// Exchanges the off-diagonal quarters of all blocks of side 2 `side`; bit j of row i becomes bit i of row j in the end.
void exchange(inout uint rows[32], uint side, uint low) {
  for (uint i = 0u; i < 16u; ++i) {
    uint k = i / side * 2u * side + i % side;
    uint t = (rows[k] >> side ^ rows[k + side]) & low;
    rows[k] ^= t << side;
    rows[k + side] ^= t;
  }
}

void transpose(inout uint rows[32]) {
  exchange(rows, 16u, 0x0000FFFFu);
  exchange(rows, 8u, 0x00FF00FFu);
  exchange(rows, 4u, 0x0F0F0F0Fu);
  exchange(rows, 2u, 0x33333333u);
  exchange(rows, 1u, 0x55555555u);
}

void main() {
  uvec2 at = gl_GlobalInvocationID.xy;
  if (at.x >= words_a_row() || at.y >= uint(frame.viewport.y)) return;
  uint lit[32], edges[32];
  for (uint i = 0u; i < 32u; ++i) {
    uint x = 32u * at.x + i;
    bool there = x < uint(frame.viewport.x);
    uint place = word_place(push.word, ivec2(there ? x : 0u, at.y));
    lit[i] = there ? lit_words[place] : 0u;
    edges[i] = there ? edge_words[place] : 0u;
  }
  transpose(lit);
  transpose(edges);
  for (uint i = 0u; i < 32u; ++i) {
    if (i < push.bit || i >= push.bit + push.count) continue;
    uint place = plane_place(32u * push.word + i, at.y, at.x);
    lit_planes[place] = lit[i];
    edge_planes[place] = edges[i];
  }
}
