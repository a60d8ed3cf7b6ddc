// RBSM, second half: the walks along the silhouette and the revectorized visibility, for the listed pixels.
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"

layout(local_size_x = 64) in;

Query query;

bool rbsm_lit(ivec2 texel, inout float lowering) {
#if WALK == WALK_TANGENT_PLANE
  return is_lit(query, texel);
#else
  // Section 3.1.3: the fragment's own depth, lowered by epsilon (of the depth range) where the map is that close, and kept
  // lowered for the rest of the walk: lowering that is restored is only a constant bias.
  float z = receiver_depth(query.view, query.plane, query.plane.texel, ENCODING == ENCODING_LINEAR) - lowering;
  float s = map_depth(query, texel);
  if (abs(z - s) < params.epsilon) {
    lowering += params.epsilon;
    z -= params.epsilon;
  }
  return z <= s;
#endif
}

#include "lib/revectorization.glsl"

void main() {
  ivec2 at;
  if (!listed_pixel(list_slot(), imageSize(visibility).x, at)) return;
  make_query(at, query);
  ivec2 texel = ivec2(floor(query.position));
  vec2 c = fract(query.position);  // (3.1)
  bool lit = is_lit(query, texel);
  bvec4 d = rbsm_discontinuity(texel, lit);
  vec4 distances = rbsm_distances(texel, c, lit, d, params.max_size);
  float v;
#if MODE == MODE_CONSERVATIVE
  v = any(d) ? rbsm_conservative(lit, rbsm_relative_position(distances, lit, params.max_size)) : float(lit);
#elif MODE == MODE_NON_CONSERVATIVE
  v = any(d) ? rbsm_nonconservative(lit, rbsm_relative_position(distances, lit, params.max_size)) : float(lit);
#else
  v = any(d) ? rbsm_filtered(lit, rbsm_relative_position_filtered(distances, params.max_size)) : float(lit);
#endif
  imageStore(visibility, ivec3(at, push.light), vec4(v));
}
