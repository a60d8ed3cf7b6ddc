// What a pixel shows, as far as a light's shadow on it goes. Uses the ports `depth` and `geometric` of the G-buffer.
#ifndef GNOMON_RECEIVING
#define GNOMON_RECEIVING

#include "map/views.glsl"
#include "lib/octahedral.glsl"

struct Receiving {
  vec3 position, normal;  // relative; geometric
  float depth;            // image_depth(), world units
  bool receives;          // geometry in the map that faces the light: the shadow map decides
};

// `encoded`: octahedral geometric normal. `light`, `widest`: of the layer; whoever asks in a loop loads them before it.
Receiving make_receiving(ivec2 pixel, float device_depth, vec2 encoded, Light light, LightView widest) {
  Receiving r;
  r.position = relative_position(pixel, device_depth);
  r.normal = octahedral_decode(encoded);
  r.depth = image_depth(device_depth);
  r.receives = !is_background(device_depth) && faces_light(light, r.position, r.normal) && in_map(light, widest, r.position);
  return r;
}

Receiving receiving_at(ivec2 pixel, int layer) {
  int light = light_of(layer);
  return make_receiving(pixel, depth_at(pixel).x, geometric_at(pixel).xy, lights[light], widest_view(light));
}

#endif
