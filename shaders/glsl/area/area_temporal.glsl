// Temporal coherence, first part: tests every pixel against the map of this frame's sample, adds the test to those that the frames
// before have left in the shadow buffer (5.5), and lists the pixels that these tests do not settle.
#include "area/area_temporal_query.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const float SUBPIXELS = 256.0;     // steps a pixel that image places are rounded to, as samplers do: a still view stays exact
const float LEAST_OVERLAP = 0.05;  // share of a pixel's footprint in the previous image that must show its surface

// What the previous frame's shadow buffer knows of the pixel's surface: bilinear over those of four texels that show it (5.18).
ShadowHistory reproject(vec3 p, vec3 n, float depth) {
  ShadowHistory sum = ShadowHistory(0.0, 0.0, depth, BLOCKER_UNKNOWN, false);
  vec3 place = previous_image_place(p);
  vec2 corner = round((place.xy - 0.5) * SUBPIXELS) / SUBPIXELS, low = floor(corner), part = corner - low;
  vec2 gradient = depth_gradient(p, n, depth);
  ivec2 size = imageSize(history).xy;
  bool visible = place.z > 0.0 && all(greaterThan(corner, vec2(-1.0))) && all(lessThan(corner, vec2(size)));
  if (!visible) low = vec2(0.0);
  float overlap = 0.0, blockers = 0.0, blocker = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec2 step = vec2(i & 1, i >> 1);
    ivec2 texel = ivec2(low + step);
    vec2 share = mix(1.0 - part, part, step);
    bool inside = visible && all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size));
    ShadowHistory h = unpack_history(imageLoad(history, ivec3(clamp(texel, ivec2(0), size - 1), push.light)));
    float expected = place.z / (1.0 + dot(gradient, low + step - corner));
    float weight = share.x * share.y;
    if (!inside || h.tests <= 0.0 || !same_depth(expected, h.depth, params.depth_tolerance)) weight = 0.0;
    sum.shadowed += weight > 0.0 ? weight * h.shadowed : 0.0;
    sum.tests += weight > 0.0 ? weight * h.tests : 0.0;
    sum.moving = sum.moving || (weight > 0.0 && h.moving);
    overlap += weight;
    bool blocked = weight > 0.0 && h.blocker > BLOCKER_NONE;
    blocker += blocked ? weight * h.blocker : 0.0;
    blockers += blocked ? weight : 0.0;
  }
  if (overlap < LEAST_OVERLAP) return no_history(depth);
  sum.shadowed /= overlap;
  sum.tests /= overlap;
  sum.blocker = blockers > 0.0 ? blocker / blockers : BLOCKER_NONE;
  return sum;
}

ShadowHistory previous_history(ivec2 at, vec3 n) {
  float device_depth = depth_at(at).x, depth = view_depth(device_depth);
#ifdef CAMERA_MOVED
  return reproject(relative_position(at, device_depth), n, depth);
#else
  ShadowHistory h = unpack_history(imageLoad(history, ivec3(at, push.light)));
  if (h.tests <= 0.0 || !same_depth(depth, h.depth, params.depth_tolerance)) return no_history(depth);
  h.depth = depth;
  return h;
#endif
}

// What of the history still holds, the light and the casters having moved. `meets`: meets_moving().
ShadowHistory aged(ShadowHistory h, bool meets) {
  h = limit_tests(h, params.most_tests - 1.0);
  if ((push.bit & LIGHT_MOVED) != 0u) h.shadowed *= params.age, h.tests *= params.age;
#ifdef MOVING_CASTERS
  if ((push.bit & CASTERS_MOVED) != 0u && meets) h = no_history(h.depth);
  if ((push.bit & SHADOWS_FADE) != 0u && !meets && h.moving) h = fade(h, params.most_moving, params.delta);
  h.moving = meets || (h.moving && h.tests > 0.0);
#endif
  if (h.tests <= 0.0) h.blocker = BLOCKER_UNKNOWN;
  return h;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(visibility).xy;
  if (any(greaterThanEqual(at, size))) return;
  AreaReceiver receiver;
  int state = make_area_receiver(at, receiver);
  if (state == PIXEL_OTHERS) return;
  ivec3 place = ivec3(at, push.light);
  LightSample s = light_sample(push.first);
  Query query = sample_query(receiver, s, STILL_LAYER);
  ivec2 texel = map_texel(query.position);
  float map = caster_depth(texel);
  bool lit = query_depth(query, vec2(floor(query.position)) + 0.5) <= map;
  bool faced = faces_sample(receiver.view, s, receiver.q, receiver.n);
  bool inside = state == PIXEL_INSIDE;
#ifndef HISTORY
  imageStore(visibility, place, vec4(inside ? float(lit && faced) : unmapped_visibility(state)));
#else
  ShadowHistory h = aged(previous_history(at, octahedral_decode(geometric_at(at).xy)), meets_moving(query, texel));
  if (!lit && h.blocker != BLOCKER_UNKNOWN)
    h.blocker = add_blocker(h, decode_depth(query.view, map, LINEAR_MAP), float(params.blockers));
  h = add_test(h, !(lit && faced), s.weight);
  float weight = tests_weight(h, params.s_min, params.s_max, params.least_tests);
  imageStore(shadow_buffer, place, inside ? pack_history(h) : vec4(0.0));
  imageStore(visibility, place, vec4(inside ? seen_share(h) : unmapped_visibility(state)));
  if (inside && weight < 1.0 && h.blocker != BLOCKER_NONE) list_pixel(at, size.x);
  if (inside && h.blocker == BLOCKER_UNKNOWN) list_fresh_pixel(at, size.x);
#endif
}
