// From a camera pixel to its receiver in a light's shadow map: what all shadow-map techniques begin with.
// Uses the ports `depth`, `geometric` (G-buffer), `shadow_map` and `views`.
#include "map/map_query.glsl"

// A dispatch is for one light. Its index, and the first of its views, come as push constants, so that every load that depends
// on them alone is uniform. `part`: of a pass that does its work in several dispatches.
layout(push_constant) uniform Push { uint light, view; uvec2 part; } push;

// Of a surface at `p`, `n` its geometric normal. `light` and `first_view` are those of push.
int query_at(vec3 p, vec3 n, Light light, LightView first_view, out Query query) {
#if LIGHT_VIEWS > 1
  query.layer = int(view_of(light, push.view, LIGHT_VIEWS, p));
  query.view = views[query.layer];
#else
  query.layer = int(push.view);
  query.view = first_view;
#endif
  LightView view = query.view;
  float size = map_size(), light_distance;
  vec3 normal = light_space(view, vec4(n, 0.0));
  vec3 q = tested_point(view, light_space(view, vec4(p, 1.0)), normal, dot(n, to_light(light, p, light_distance)), size);
  query.plane = make_receiver(view, q, normal, size);
  query.position = query.plane.texel;
  bool seen = view_sees(vec3(query.position / size, query.plane.z));
  query.plane = biased(view, query.plane, size);
  if (!faces_light(light, p, n)) return PIXEL_AWAY;
  return seen && in_range(light, p) ? PIXEL_INSIDE : PIXEL_OUTSIDE;
}

// Of what a pixel shows. Whoever asks in a loop loads `light` and `first_view` before it.
int make_query(ivec2 pixel, float device_depth, vec3 n, Light light, LightView first_view, out Query query) {
  int state = query_at(relative_position(pixel, device_depth), n, light, first_view, query);
  return is_background(device_depth) ? PIXEL_BACKGROUND : state;
}

int make_query(ivec2 pixel, out Query query) {
  vec3 n = octahedral_decode(geometric_at(pixel).xy);
  return make_query(pixel, depth_at(pixel).x, n, lights[push.light], views[push.view], query);
}
