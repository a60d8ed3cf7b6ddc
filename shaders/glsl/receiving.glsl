// What a pixel shows, as far as a light's shadow on it goes. Uses the ports `depth` and `geometric` of the G-buffer.
#ifndef GNOMON_RECEIVING
#define GNOMON_RECEIVING

#include "frame.glsl"
#include "lib/octahedral.glsl"

struct Receiving {
  vec3 position, normal;  // relative; geometric
  float depth;            // along the view axis, world units
  bool receives;          // geometry in the map that faces the light: the shadow map decides
};

// `encoded`: octahedral geometric normal. `layer`: the light's.
Receiving make_receiving(ivec2 pixel, float device_depth, vec2 encoded, int layer) {
  int light = light_of(layer);
  Receiving r;
  r.position = relative_position(pixel, device_depth);
  r.normal = octahedral_decode(encoded);
  r.depth = view_depth(device_depth);
  r.receives = !is_background(device_depth) && faces_light(lights[light], r.position, r.normal) && in_map(light, r.position);
  return r;
}

Receiving receiving_at(ivec2 pixel, int layer) {
  return make_receiving(pixel, depth_at(pixel).x, geometric_at(pixel).xy, layer);
}

#endif
