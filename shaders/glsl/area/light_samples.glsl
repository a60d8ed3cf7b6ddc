// The samples of the scene's area lights, as passes/area/sample_maps.h uploads them.
#include "frame/frame.glsl"
#include "lib/light_sample.glsl"

// Face `i` of the scene's light faces, widened for its light's samples.
LightFace area_face(uint i) {
  LightFace face;
  uint at = 5u * i;
  face.rows[0] = areas[at];
  face.rows[1] = areas[at + 1u];
  face.rows[2] = areas[at + 2u];
  face.range = areas[at + 3u];
  face.info = floatBitsToUint(areas[at + 4u]);
  return face;
}

LightSample light_sample(uint i) {
  vec4 place = samples[2u * i], rest = samples[2u * i + 1u];
  return LightSample(place.xyz, rest.xy, place.w, int(rest.z));
}
