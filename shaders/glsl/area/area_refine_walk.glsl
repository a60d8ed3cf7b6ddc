// The filtered visibility (4.2) of listed pixels for the new samples on whose silhouettes they lie. It is what final
// rendering (6.4) needs of a sample's map, which can then be given up.
#include "area/area_query.glsl"
#include "area/area_words.glsl"
#include "frame/pixel_list.glsl"

layout(local_size_x = 64) in;

Query query;

#if TEST == TEST_PCF
float sample_visibility() {
  return dot(lit_quad(query, ivec2(floor(query.position - 0.5))), vec4(0.25));
}
#else
bool rbsm_lit(ivec2 texel, inout float lowering) { return is_lit(query, texel); }

#include "lib/revectorization.glsl"

float rbsm_at(vec2 position) {
  ivec2 texel = ivec2(floor(position));
  bool lit = is_lit(query, texel);
  bvec4 d = rbsm_discontinuity(texel, lit);
  vec4 distances = rbsm_distances(texel, fract(position), lit, d, params.max_size);
  return any(d) ? rbsm_filtered(lit, rbsm_relative_position_filtered(distances, params.max_size)) : float(lit);
}

float sample_visibility() {
#if TEST == TEST_RPCF
  // Algorithm 2 with a kernel of 2 x 2 (ch. 6.2.1).
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) sum += rbsm_at(query.position + vec2(i & 1, i >> 1) - 0.5);
  return 0.25 * sum;
#else
  return rbsm_at(query.position);
#endif
}
#endif

void main() {
  ivec2 at;
  if (!listed_pixel(list_slot(), int(frame.viewport.x), at)) return;
  AreaReceiver receiver;
  make_area_receiver(at, receiver);
  uint all_new = push.count < 32u ? (1u << push.count) - 1u : 0xFFFFFFFFu;
  uint left = KEEP_ALL == 1 ? all_new : edge_words[word_place(push.part.x, at)] >> push.bit & all_new;
  while (left != 0u) {
    uint i = uint(findLSB(left));
    left &= left - 1u;
    LightSample s = light_sample(push.first + i);
    query = sample_query(receiver, s, s.layer);
    imageStore(values, ivec3(at, 32u * push.part.x + push.bit + i), vec4(sample_visibility()));
  }
}
