// A receiver's place in one layer of a shadow map, and the shadow test (3.2) there and around it. Pure functions. Beyond a map's
// border its last texels are repeated. `linear`: the map's depth is (3.7), not (3.6).
#ifndef GNOMON_MAP_QUERY_LIB
#define GNOMON_MAP_QUERY_LIB

#include "receiver_plane.glsl"

struct Query {
  int layer;        // of the map
  LightView view;   // of that layer; here, so that loops over texels do not load it again
  vec2 position;    // in the map, texels
  Receiver plane;   // biased
};

float query_depth(Query query, vec2 at, bool linear) { return receiver_depth(query.view, query.plane, at, linear); }

float map_depth(sampler2DArray map, Query query, ivec2 texel) {
  ivec2 last = textureSize(map, 0).xy - 1;
  return texelFetch(map, ivec3(clamp(texel, ivec2(0), last), query.layer), 0).x;
}

// At a texel, for the receiver's tangent plane there.
bool map_lit(sampler2DArray map, Query query, ivec2 texel, bool linear) {
  return query_depth(query, vec2(texel) + 0.5, linear) <= map_depth(map, query, texel);
}

// The same for a texel and its neighbours: x left, y right, z top, w bottom. Two gathers read what five fetches would; they
// stand on corners between texels, where no rounding can choose other ones.
bool map_lit_cross(sampler2DArray map, Query query, ivec2 texel, bool linear, out bvec4 neighbours) {
  vec2 size = vec2(textureSize(map, 0).xy);
  vec4 low = textureGather(map, vec3(vec2(texel) / size, query.layer));       // (-1,0) (0,0) (0,-1) (-1,-1)
  vec4 high = textureGather(map, vec3(vec2(texel + 1) / size, query.layer));  // (0,1) (1,1) (1,0) (0,0)
  vec2 centre = vec2(texel) + 0.5;
  neighbours.x = query_depth(query, centre - vec2(1.0, 0.0), linear) <= low.x;
  neighbours.y = query_depth(query, centre + vec2(1.0, 0.0), linear) <= high.z;
  neighbours.z = query_depth(query, centre - vec2(0.0, 1.0), linear) <= low.z;
  neighbours.w = query_depth(query, centre + vec2(0.0, 1.0), linear) <= high.x;
  return query_depth(query, centre, linear) <= low.y;
}

// At `texel` and its neighbours right, below and diagonally below, which one gather reads: x (0,1), y (1,1), z (1,0), w (0,0), as a
// gather orders them; 1 is lit.
vec4 map_lit_quad(sampler2DArray map, Query query, ivec2 texel, bool linear) {
  ivec2 size = textureSize(map, 0).xy;
  vec4 depths = textureGather(map, vec3(vec2(texel + 1) / vec2(size), query.layer));
  vec2 low = vec2(clamp(texel, ivec2(0), size - 1)) + 0.5;
  vec2 high = vec2(clamp(texel + 1, ivec2(0), size - 1)) + 0.5;
  vec4 receiver = receiver_depths(query.view, query.plane, vec4(low.x, high.x, high.x, low.x),
                                  vec4(high.y, high.y, low.y, low.y), linear);
  return vec4(lessThanEqual(receiver, depths));
}

#endif
