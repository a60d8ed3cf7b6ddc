// Mean depth of what hides some of a light from each listed pixel (Fernando 2005; Macedo 2018, eq. 5.1), and the width of its
// penumbra (5.2). Depths are linear; sums have no epsilon, and no blocker is told as such.
//
// PROTOCOL_EXACT: the search begins with the region that blockers on the near plane could be in, and shrinks it to that of the
// nearest depth in it until it no longer changes, by a min-max pyramid. All blockers of the region count, also those beside the
// light. PROTOCOL_THESIS (ch. 5.5.1): the first of these regions, as it is, by a constant number of taps.
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"
#include "map/light_kernel.glsl"
#include "map/search_region.glsl"

layout(local_size_x = 64) in;

const int UMBRA_TAPS = 3;  // where all of the region blocks: any mean of it will do

// x: sum of the blockers' depths among so many taps a side, evenly spread over the region; y: their number. When the region has
// no more texels a side than taps, each is one tap.
vec2 blockers_in(Query query, Region region) {
  ivec2 texels = region.high - region.low + 1, last = textureSize(shadow_map, 0).xy - 1;
  ivec2 taps = min(texels, ivec2(region.all_block ? UMBRA_TAPS : params.taps));
  vec2 sum = vec2(0.0);
  // Bounds that are the same for all invocations: with others, lavapipe's sums depend on which pixels are neighbours in the list.
  for (int y = 0; y < params.taps; ++y)
    for (int x = 0; x < params.taps; ++x) {
      if (x >= taps.x || y >= taps.y) continue;
      ivec2 texel = clamp(region.low + (texels * (2 * ivec2(x, y) + 1)) / (2 * taps), ivec2(0), last);
      float plane = receiver_depth(query.view, query.plane, vec2(texel) + 0.5, ENCODING == ENCODING_LINEAR);
      float depth = map_depth(query, texel);
      if (blocks(depth, plane)) sum += vec2(linear_depth(query.view, depth), 1.0);
    }
  return sum;
}

// Linear, or NO_BLOCKER. Where taps miss what the pyramid knows of, its nearest depth stands: the filter over the widest kernel
// that there may be then tells how much is hidden.
float find_blocker(ivec2 at, Query query, Light light) {
#if PROTOCOL == PROTOCOL_EXACT
  Region region = find_region(query, light);
#else
  Region region = first_region(query, half_size_of(light), size_of(light));
#endif
  if (!region.blocks) return NO_BLOCKER;
  vec2 sum = blockers_in(query, region);
  float z_b = sum.y > 0.0 ? sum.x / sum.y : region.nearest;
  return blocker_before(query, z_b);
}

#include "soft/listed_blocker.glsl"
