// From a camera pixel to its receiver in the maps of an area light's samples. Uses the ports `depth`, `geometric`, `views` and `maps`
// and the parameters of passes/area/sample_maps.h.
#define SHADOW_MAP maps
#include "map/map_query.glsl"
#include "area/light_samples.glsl"

// A dispatch is for one view of a light and `count` samples from `first` on, the first of which is layer `layer` of the maps.
layout(push_constant) uniform Push { uint light, view, first, count, layer, bit; uvec2 part; } push;

struct AreaReceiver {
  LightView view;
  vec3 q, n;  // position and unit geometric normal in the view's frame
};

int make_area_receiver(ivec2 pixel, out AreaReceiver receiver) {
  float device_depth = depth_at(pixel).x;
  vec3 n = octahedral_decode(geometric_at(pixel).xy);
  vec3 p = relative_position(pixel, device_depth);
  Light light = lights[push.light];
  receiver.view = area_view(push.view);
  receiver.q = light_space(receiver.view, vec4(p, 1.0));
  receiver.n = light_space(receiver.view, vec4(n, 0.0));
#if LIGHT_VIEWS > 1
  if (view_of(light, views_of(int(push.light)).x, LIGHT_VIEWS, p) != push.view) return PIXEL_OTHERS;
#endif
  if (is_background(device_depth)) return PIXEL_BACKGROUND;
  if (!faces_light(light, p, n)) return PIXEL_AWAY;
  vec3 seen = light_project(views[push.view], receiver.q);
  return view_sees(seen) && in_range(light, p) ? PIXEL_INSIDE : PIXEL_OUTSIDE;
}

// In the map of sample `s`, which is layer `layer`.
Query sample_query(AreaReceiver receiver, LightSample s, int layer) {
  float size = map_size();
  vec3 q = tested_point(receiver.view, receiver.q, receiver.n, facing_sample(receiver.view, s, receiver.q, receiver.n), size);
  Query query;
  query.layer = layer;
  query.view = receiver.view;
  query.plane = sample_receiver(receiver.view, s, q, receiver.n, size);
  query.position = query.plane.texel;
  query.plane = biased(receiver.view, query.plane, size);
  return query;
}
