// What the shaders of passes/area/area_temporal.cpp share. Of a dispatch: `push.first` is the light's sample of this frame, `push.part.x`
// the light's size in world units (float bits), `push.bit` what has changed since the frame before.
#include "area/area_query.glsl"
#include "lib/temporal_shadow.glsl"
#include "frame/pixel_list.glsl"

// LIGHT_MOVED, CASTERS_MOVED, SHADOWS_FADE: bits of push.bit, as the pass defines them.

const int STILL_LAYER = 0, MOVING_LAYER = 1;  // of `maps`: casters that stand still (or all), casters that may move

const float STEEPEST = 0.1;        // change of depth from pixel to pixel, of itself, beyond which no surface is followed

// Relative change of the reciprocal view depth of the plane through `p` with normal `n`, per pixel to the right and down.
vec2 depth_gradient(vec3 p, vec3 n, float depth) {
#ifdef ORTHOGRAPHIC_CAMERA
  float distance = depth * dot(n, view_axis());
  vec2 g = image_depth(0.0) * vec2(dot(n, frame.ray_dx.xyz), dot(n, frame.ray_dy.xyz));  // at any depth
#else
  float distance = dot(n, p);
  vec2 g = depth * vec2(dot(n, frame.ray_dx.xyz), dot(n, frame.ray_dy.xyz));
#endif
  return clamp(g / (abs(distance) > 1e-6 * depth ? distance : 1e-6 * depth), vec2(-STEEPEST), vec2(STEEPEST));
}

ivec2 map_texel(vec2 place) { return clamp(ivec2(floor(place)), ivec2(0), textureSize(maps, 0).xy - 1); }

// Depth of the nearest caster in a texel.
float caster_depth(ivec2 texel) {
  float depth = maps_at(texel, STILL_LAYER).x;
#ifdef MOVING_CASTERS
  depth = min(depth, maps_at(texel, MOVING_LAYER).x);
#endif
  return depth;
}

// Is what is nearest to the light in a moving texel at or in front of the receiver, by the bias to either side? True in a moving
// caster's shadow and on the moving caster itself.
bool meets_moving(Query query, ivec2 texel) {
#ifdef MOVING_CASTERS
  float biased = far_distance(query.view, query.plane.base);
  query.plane = bias_receiver(query.view, query.plane, biased - query.plane.z);
  return query_depth(query, vec2(texel) + 0.5) > maps_at(texel, MOVING_LAYER).x;
#else
  return false;
#endif
}

// A second list: of new pixels.
PIXEL_LIST(list_fresh_pixel, fresh_pixel, fresh, fresh_arguments)
