// From a camera pixel to its receiver in a light's shadow map: what all shadow-map techniques begin with.
// Uses the ports `depth`, `geometric` (G-buffer) and `shadow_map`, and the parameters of passes/map/receiver_ports.h.
#include "frame/frame.glsl"
#include "lib/octahedral.glsl"
#include "lib/receiver_plane.glsl"
#include "frame/pixel_state.glsl"

// A dispatch is for one light. Its index, and the only face of a light that has one, come as push constants, so that every
// load that depends on them alone is uniform. `part`: of a pass that does its work in several dispatches.
layout(push_constant) uniform Push { uint light, face; uvec2 part; } push;

struct Query {
  int layer;        // of the map
  LightFace face;   // of that layer; here, so that loops over texels do not load it again
  vec2 position;    // in the map, texels
  Receiver plane;
};

float map_size() { return float(textureSize(shadow_map, 0).x); }

// World units, along the face's axis.
float bias_world(float texel_size, float slope) {
#if BIAS == BIAS_NONE
  return 0.0;
#elif BIAS == BIAS_SLOPE_SCALED || BIAS == BIAS_RECEIVER_PLANE || BIAS == BIAS_BACK_FACE || BIAS == BIAS_MIDPOINT
  return texel_size * (params.bias_constant + params.bias_slope * slope);
#else
  return texel_size * params.bias_constant;
#endif
}

// `n`: geometric normal. `light` and `only_face` are those of push: whoever asks in a loop loads them before it.
int make_query(ivec2 pixel, float device_depth, vec3 n, Light light, LightFace only_face, out Query query) {
  vec3 p = relative_position(pixel, device_depth);
#ifdef SIX_FACES
  query.layer = int(face_of(light, p));
  query.face = faces[query.layer];
#else
  query.layer = int(push.face);
  query.face = only_face;
#endif
  LightFace face = query.face;
  vec3 q = face_space(face, vec4(p, 1.0));
  float size = map_size();
#if BIAS == BIAS_NORMAL_OFFSET
  // Holbert 2011: along the geometric normal, by texels, more where the light grazes.
  float light_distance, facing = dot(n, to_light(light, p, light_distance));
  float sine = sqrt(max(1.0 - facing * facing, 0.0));
  float offset = texel_world_size(face, -q.z, size) * params.bias_normal * sine;
  q += offset * face_space(face, vec4(n, 0.0));
#endif
  query.plane = make_receiver(face, q, face_space(face, vec4(n, 0.0)), size);
  query.position = query.plane.texel;
  bool seen = face_sees(vec3(query.position / size, query.plane.z));
  query.plane = bias_receiver(face, query.plane, bias_world(texel_world_size(face, query.plane.z, size), query.plane.slope));
#if BIAS != BIAS_RECEIVER_PLANE
  // The pixel's own depth stands for its own texel; the plane tells only how neighbours differ from it.
  query.plane.texel = floor(query.plane.texel) + 0.5;
#endif
  if (is_background(device_depth)) return PIXEL_BACKGROUND;
  if (!faces_light(light, p, n)) return PIXEL_AWAY;
  return seen && in_range(light, p) ? PIXEL_INSIDE : PIXEL_OUTSIDE;
}

int make_query(ivec2 pixel, out Query query) {
  vec3 n = octahedral_decode(geometric_at(pixel).xy);
  return make_query(pixel, depth_at(pixel).x, n, lights[push.light], faces[push.face], query);
}

float map_depth(Query query, ivec2 texel) {
  ivec2 last = textureSize(shadow_map, 0).xy - 1;
  return shadow_map_at(clamp(texel, ivec2(0), last), query.layer).x;
}

// (3.2) at a texel, for the receiver's tangent plane there.
bool is_lit(Query query, ivec2 texel) {
  float receiver = receiver_depth(query.face, query.plane, vec2(texel) + 0.5, ENCODING == ENCODING_LINEAR);
  return receiver <= map_depth(query, texel);
}

// The same for a texel and its neighbours: x left, y right, z top, w bottom. Two gathers read what five fetches would; they
// stand on corners between texels, where no rounding can choose other ones.
bool is_lit_cross(Query query, ivec2 texel, out bvec4 neighbours) {
  vec2 size = vec2(textureSize(shadow_map, 0).xy);
  vec4 low = textureGather(shadow_map, vec3(vec2(texel) / size, query.layer));       // (-1,0) (0,0) (0,-1) (-1,-1)
  vec4 high = textureGather(shadow_map, vec3(vec2(texel + 1) / size, query.layer));  // (0,1) (1,1) (1,0) (0,0)
  vec2 centre = vec2(texel) + 0.5;
  LightFace face = query.face;
  bool linear = ENCODING == ENCODING_LINEAR;
  neighbours.x = receiver_depth(face, query.plane, centre - vec2(1.0, 0.0), linear) <= low.x;
  neighbours.y = receiver_depth(face, query.plane, centre + vec2(1.0, 0.0), linear) <= high.z;
  neighbours.z = receiver_depth(face, query.plane, centre - vec2(0.0, 1.0), linear) <= low.z;
  neighbours.w = receiver_depth(face, query.plane, centre + vec2(0.0, 1.0), linear) <= high.x;
  return receiver_depth(face, query.plane, centre, linear) <= low.y;
}

// (3.2) at `texel` and its neighbours right, below and diagonally below, which one gather reads: x (0,1), y (1,1), z (1,0),
// w (0,0), as a gather orders them; 1 is lit. Beyond the map's border its last texels are repeated.
vec4 lit_quad(Query query, ivec2 texel) {
  ivec2 size = textureSize(shadow_map, 0).xy;
  vec4 map = textureGather(shadow_map, vec3(vec2(texel + 1) / vec2(size), query.layer));
  vec2 low = vec2(clamp(texel, ivec2(0), size - 1)) + 0.5;
  vec2 high = vec2(clamp(texel + 1, ivec2(0), size - 1)) + 0.5;
  vec4 receiver = receiver_depths(query.face, query.plane, vec4(low.x, high.x, high.x, low.x),
                                  vec4(high.y, high.y, low.y, low.y), ENCODING == ENCODING_LINEAR);
  return vec4(lessThanEqual(receiver, map));
}
