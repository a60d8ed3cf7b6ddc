// From a camera pixel to its receiver in the maps of an area light's samples. Uses the ports `depth`, `geometric` and `maps`
// and the parameters of passes/area/sample_maps.h.
#include "lib/octahedral.glsl"
#include "area/light_samples.glsl"
#include "frame/pixel_state.glsl"

// A dispatch is for one face of a light and `count` samples from `first` on, the first of which is layer `layer` of the maps.
layout(push_constant) uniform Push { uint light, face, first, count, layer, bit; uvec2 part; } push;

struct AreaReceiver {
  LightFace face;
  vec3 q, n;  // position and unit geometric normal in the face's frame
};

float map_size() { return float(textureSize(maps, 0).x); }

int make_area_receiver(ivec2 pixel, out AreaReceiver receiver) {
  float device_depth = depth_at(pixel).x;
  vec3 n = octahedral_decode(geometric_at(pixel).xy);
  vec3 p = relative_position(pixel, device_depth);
  Light light = lights[push.light];
  receiver.face = area_face(push.face);
  receiver.q = face_space(receiver.face, vec4(p, 1.0));
  receiver.n = face_space(receiver.face, vec4(n, 0.0));
#ifdef SIX_FACES
  if (face_of(light, p) != push.face) return PIXEL_OTHERS;
#endif
  if (is_background(device_depth)) return PIXEL_BACKGROUND;
  if (!faces_light(light, p, n)) return PIXEL_AWAY;
  vec3 seen = face_project(faces[push.face], receiver.q);
  return face_sees(seen) && in_range(light, p) ? PIXEL_INSIDE : PIXEL_OUTSIDE;
}

// The receiver's plane in the map of sample `s`, bias included.
Receiver plane_in(AreaReceiver receiver, LightSample s) {
  float size = map_size();
  Receiver plane = sample_receiver(receiver.face, s, receiver.q, receiver.n, size);
  float texel = texel_world_size(receiver.face, plane.z, size);
  return bias_receiver(receiver.face, plane, texel * (params.bias_constant + params.bias_slope * plane.slope));
}

float plane_depth(AreaReceiver receiver, Receiver plane, vec2 at) {
  return receiver_depth(receiver.face, plane, at, false);
}

// (3.2) at a texel of layer `layer`, for the receiver's tangent plane there.
bool is_lit(AreaReceiver receiver, Receiver plane, ivec2 texel, int layer) {
  ivec2 last = textureSize(maps, 0).xy - 1;
  return plane_depth(receiver, plane, vec2(texel) + 0.5) <= maps_at(clamp(texel, ivec2(0), last), layer).x;
}

// The same for a texel and its neighbours: x left, y right, z top, w bottom, by two gathers on corners between texels.
bool is_lit_cross(AreaReceiver receiver, Receiver plane, ivec2 texel, int layer, out bvec4 neighbours) {
  vec2 size = vec2(textureSize(maps, 0).xy);
  vec4 low = textureGather(maps, vec3(vec2(texel) / size, layer));       // (-1,0) (0,0) (0,-1) (-1,-1)
  vec4 high = textureGather(maps, vec3(vec2(texel + 1) / size, layer));  // (0,1) (1,1) (1,0) (0,0)
  vec2 centre = vec2(texel) + 0.5;
  vec4 x = centre.x + vec4(-1.0, 1.0, 0.0, 0.0), y = centre.y + vec4(0.0, 0.0, -1.0, 1.0);
  vec4 depths = receiver_depths(receiver.face, plane, x, y, false);
  neighbours = lessThanEqual(depths, vec4(low.x, high.z, low.z, high.x));
  return plane_depth(receiver, plane, centre) <= low.y;
}

// (3.2) at `texel` and its neighbours right, below and diagonally below, as a gather orders them; 1 is lit.
vec4 lit_quad(AreaReceiver receiver, Receiver plane, ivec2 texel, int layer) {
  vec4 map = textureGather(maps, vec3(vec2(texel + 1) / vec2(textureSize(maps, 0).xy), layer));
  vec2 centre = vec2(texel) + 0.5;
  vec4 x = centre.x + vec4(0.0, 1.0, 1.0, 0.0), y = centre.y + vec4(1.0, 1.0, 0.0, 0.0);
  return vec4(lessThanEqual(receiver_depths(receiver.face, plane, x, y, false), map));
}
