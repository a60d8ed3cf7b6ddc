// Mean depth of what hides some of a light from each listed pixel, from means over the region in which it may be, and the width of
// its penumbra (Macedo 2018, eq. 5.2). The region is cut in parts, each against the receiver's plane at its middle: so a tilted
// receiver, or one in front of the region's mean, is told from what hides the light (Yang et al. 2010, section 4.2).
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"
#include "map/light_kernel.glsl"
#include "map/search_region.glsl"
#include "filtered/table_mean.glsl"
#include "filtered/stored_moments.glsl"
#include "lib/moment_occluders.glsl"

layout(local_size_x = 64) in;

const float LEAST_SHARE = 1e-3;  // of the region: what rounding makes of none

// What is nearer than depth `t`, the plane's mean over the texels from `low` to before `end`.
vec2 occluders_in(Query query, ivec2 low, ivec2 end, float t) {
  int layer = query.layer * MOMENT_LAYERS;
#if BASIS == BASIS_VARIANCE
  return variance_occluders(table_mean(low, end, layer).xy, t, params.minimum_variance);
#elif BASIS == BASIS_FOUR_MOMENTS
  return four_moment_occluders(biased_moments(table_mean(low, end, layer), HAMBURGER_CENTRE), t);
#elif BASIS == BASIS_EXPONENTIAL_DEPTH
  vec2 rise = params.exponent * linear_rise(query, 0.5 * vec2(end - low));
  float plane = exp(params.exponent * (t - 1.0)) * mean_of_exponential(rise.x) * mean_of_exponential(rise.y);
  return exponential_occluders(vec3(table_mean(low, end, layer).xy, table_mean(low, end, layer + 1).x), t, plane);
#else
  vec2 test = vec2(0.0);  // the filtered test, and that of depths
  vec2 even = csm_first(t), rotation = csm_rotation(t);
  for (int i = 0; i < SERIES_LAYERS; ++i) {
    vec4 b = table_mean(low, end, layer + i), zb = table_mean(low, end, layer + SERIES_LAYERS + i);
    vec2 odd = csm_next(even, rotation);
    test += vec2(csm_term(b.xy, even, 2 * i, params.terms, params.ringing), csm_term(zb.xy, even, 2 * i, params.terms, params.ringing));
    if (2 * i + 1 < params.terms)
      test += vec2(csm_term(b.zw, odd, 2 * i + 1, params.terms, params.ringing),
                   csm_term(zb.zw, odd, 2 * i + 1, params.terms, params.ringing));
    even = csm_next(odd, rotation);
  }
  return fourier_occluders(test, t);
#endif
}

// Linear, or NO_BLOCKER.
float find_blocker(ivec2 at, Query query, Light light) {
  Region region = find_region(query, light);
  if (!region.blocks) return NO_BLOCKER;
  ivec2 last = textureSize(shadow_map, 0).xy - 1;
  ivec2 low = clamp(region.low, ivec2(0), last), texels = clamp(region.high, ivec2(0), last) - low + 1;
  vec2 sum = vec2(0.0);
  // One loop: lavapipe crashes when it compiles two.
  for (int i = 0; i < params.parts * params.parts; ++i) {
    ivec2 part = ivec2(i % params.parts, i / params.parts);
    ivec2 from = low + texels * part / params.parts, end = low + texels * (part + 1) / params.parts, size = end - from;
    float t = receiver_depth(query.view, query.plane, 0.5 * vec2(from + end), true);
    if (size.x * size.y > 0) sum += float(size.x * size.y) * occluders_in(query, from, end, t);
  }
  if (sum.x <= LEAST_SHARE * float(texels.x * texels.y)) return NO_BLOCKER;
  return blocker_before(query, max(decode_linear(query.view, sum.y / sum.x), region.nearest));
}

#include "soft/listed_blocker.glsl"
