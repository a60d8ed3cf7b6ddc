// The samples of the scene's area lights, as passes/area/sample_maps.h uploads them.
#include "map/views.glsl"
#include "lib/light_sample.glsl"

// Face `i` of the scene's light views, widened for its light's samples.
LightView area_view(uint i) {
  LightView view;
  uint at = 5u * i;
  view.rows[0] = areas[at];
  view.rows[1] = areas[at + 1u];
  view.rows[2] = areas[at + 2u];
  view.range = areas[at + 3u];
  view.info = floatBitsToUint(areas[at + 4u]);
  return view;
}

LightSample light_sample(uint i) {
  vec4 place = samples[2u * i], rest = samples[2u * i + 1u];
  return LightSample(place.xyz, rest.xy, place.w, int(rest.z));
}
