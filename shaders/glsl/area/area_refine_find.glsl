// Tests every pixel against some new samples (3.2), finds the samples on whose silhouettes it lies (3.3), and lists the
// pixels that lie on any.
#include "area/area_query.glsl"
#include "area/area_words.glsl"
#include "frame/pixel_list.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// PART_NO_CASTERS, of push.part.y: there are no maps, for nothing casts a shadow of this light.

bool sample_lit(Query query, out bool edge) {
  ivec2 texel = ivec2(floor(query.position));
#if TEST == TEST_PCF
  vec4 quad = lit_quad(query, ivec2(floor(query.position - 0.5)));
  float lit = dot(quad, vec4(1.0));
  edge = lit > 0.5 && lit < 3.5;
  return is_lit(query, texel);
#else
  bvec4 neighbours;
  bool lit = is_lit_cross(query, texel, neighbours);
  edge = lit ? !all(neighbours) : any(neighbours);
  return lit;
#endif
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = ivec2(frame.viewport.xy);
  if (any(greaterThanEqual(at, size))) return;
  AreaReceiver receiver;
  int state = make_area_receiver(at, receiver);
  if (state == PIXEL_OTHERS) return;
  if (state == PIXEL_INSIDE && push.part.y == PART_NO_CASTERS) state = PIXEL_OUTSIDE;
  uint lit = 0u, edges = 0u;
  uint count = state == PIXEL_INSIDE ? push.count : 0u;
  for (uint i = 0u; i < count; ++i) {
    LightSample s = light_sample(push.first + i);
    bool edge;
    bool seen = sample_lit(sample_query(receiver, s, s.layer), edge);
    bool towards = faces_sample(receiver.view, s, receiver.q, receiver.n);
    lit |= uint(seen && towards) << i;
    edges |= uint(edge && towards) << i;
  }
  uint all_new = push.count < 32u ? (1u << push.count) - 1u : 0xFFFFFFFFu;
  if (state == PIXEL_BACKGROUND || state == PIXEL_OUTSIDE) lit = all_new;
  uint place = word_place(push.part.x, at);
  lit_words[place] = (push.bit == 0u ? 0u : lit_words[place]) | lit << push.bit;
  edge_words[place] = (push.bit == 0u ? 0u : edge_words[place]) | edges << push.bit;
  if (edges != 0u || (KEEP_ALL == 1 && count > 0u)) list_pixel(at, size.x);
}
