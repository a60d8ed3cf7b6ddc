// Shadow tests against the map of a pass, whichever it is: `shadow_map`, or what SHADOW_MAP names. Uses the parameters that
// passes/map/receiver_ports.h declares.
#include "map/views.glsl"
#include "lib/map_query.glsl"
#include "lib/octahedral.glsl"
#include "frame/pixel_state.glsl"

#ifndef SHADOW_MAP
#define SHADOW_MAP shadow_map
#endif

const bool LINEAR_MAP = ENCODING == ENCODING_LINEAR;

float map_size() { return float(textureSize(SHADOW_MAP, 0).x); }

// World units, along the view's axis.
float bias_world(float texel_size, float slope) {
#if BIAS == BIAS_NONE
  return 0.0;
#elif BIAS == BIAS_SLOPE_SCALED || BIAS == BIAS_RECEIVER_PLANE || BIAS == BIAS_BACK_FACE || BIAS == BIAS_MIDPOINT
  return texel_size * (params.bias_constant + params.bias_slope * slope);
#else
  return texel_size * params.bias_constant;
#endif
}

// Where a receiver at `q` with unit normal `n`, both in the view's frame, is tested. `facing`: cosine of the light's angle to `n`.
vec3 tested_point(LightView view, vec3 q, vec3 n, float facing, float size) {
#if BIAS == BIAS_NORMAL_OFFSET
  // Holbert 2011: along the geometric normal, by texels, more where the light grazes.
  float sine = sqrt(max(1.0 - facing * facing, 0.0));
  float offset = texel_world_size(view, -q.z, size) * params.bias_normal * sine;
  q += offset * n;
#endif
  return q;
}

Receiver biased(LightView view, Receiver plane, float size) {
  plane = bias_receiver(view, plane, bias_world(texel_world_size(view, plane.z, size), plane.slope));
#if BIAS != BIAS_RECEIVER_PLANE
  // The pixel's own depth stands for its own texel; the plane tells only how neighbours differ from it.
  plane.texel = floor(plane.texel) + 0.5;
#endif
  return plane;
}

float map_depth(Query query, ivec2 texel) { return map_depth(SHADOW_MAP, query, texel); }
float query_depth(Query query, vec2 at) { return query_depth(query, at, LINEAR_MAP); }
bool is_lit(Query query, ivec2 texel) { return map_lit(SHADOW_MAP, query, texel, LINEAR_MAP); }
bool is_lit_cross(Query query, ivec2 texel, out bvec4 neighbours) {
  return map_lit_cross(SHADOW_MAP, query, texel, LINEAR_MAP, neighbours);
}
vec4 lit_quad(Query query, ivec2 texel) { return map_lit_quad(SHADOW_MAP, query, texel, LINEAR_MAP); }
