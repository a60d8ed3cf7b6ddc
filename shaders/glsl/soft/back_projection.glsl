// Back-projection, second half: which of the light's points the texels of the map hide from each listed pixel (Macedo 2018, ch.
// 2.5.2; Guennebaud et al. 2006; with bit masks: Schwarz and Stamminger 2007).
//
// What is near to the receiver hides much of the light with few texels, what is far little with many: so texels are read by taps that
// stand the further apart, the further they are from the receiver's place. There are squares of at most `taps` a side, each twice as
// wide as the one inside of it, whose taps hardly are read again; the first has a tap a texel. A tap that is nearer than the receiver's
// plane is a patch, which reaches to the patches at its left and above where both are one surface. SILHOUETTE_REVECTORIZED: patches
// of the first square that the shadow's silhouette passes are cut by it, as revectorization has it (3.9), at 4x4 places of each.
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"
#include "map/light_kernel.glsl"
#include "map/search_region.glsl"
#include "map/back_projection.glsl"
#include "map/horizon.glsl"

layout(local_size_x = 64) in;

struct Grid {
  ivec2 low, taps;         // first texel; taps
  int stride;              // texels a tap stands for
  ivec2 inner_low, inner;  // taps that another grid is read instead of, first and number
};

// The grid of so many texels a tap over a region around `own`.
Grid grid_over(Region region, ivec2 own, int stride) {
  ivec2 reach = max(region.high - own, own - region.low) + 1, half_taps = min((reach + stride - 1) / stride, ivec2(params.taps / 2));
  Grid grid;
  grid.stride = stride;
  grid.taps = 2 * half_taps;
  grid.low = own - half_taps * stride;
  // Those at its border are read again: what they are part of may end beyond it.
  grid.inner = stride == 1 ? ivec2(0) : ivec2(params.taps / 2 - 2);
  grid.inner_low = half_taps - params.taps / 4 + 1;
  return grid;
}

bool is_inner(Grid grid, ivec2 tap) {
  return all(greaterThanEqual(tap, grid.inner_low)) && all(lessThan(tap, grid.inner_low + grid.inner));
}

// What a tap reads: the middle of the texels that it stands for, or what is half a texel beyond it.
ivec2 texel_of(Grid grid, ivec2 tap) { return grid.low + tap * grid.stride + grid.stride / 2; }

// The corner of a tap's square, whose middle is that of the texel that it reads.
vec2 low_of(Grid grid, ivec2 tap) { return vec2(texel_of(grid, tap)) + 0.5 - 0.5 * float(grid.stride); }

Query query;
BackProjection receiver;
float own_depth;  // of the receiver, as the map encodes depth, without bias
Grid grid;
LightMask mask;
uint overlapping;  // points' weights, each as often as a patch hides it
uint planes[MASK_PLANES * MASK_WORDS];  // weights of the light's points

// Is what the map holds nearer than the receiver's plane, and than the receiver itself?
bool hides(ivec2 texel) {
  texel = clamp(texel, ivec2(0), textureSize(shadow_map, 0).xy - 1);
  return blocks(map_depth(query, texel), min(query_depth(query, vec2(texel) + 0.5), own_depth));
}

// 0 where it hides nothing.
float magnification_of(ivec2 texel) {
  texel = clamp(texel, ivec2(0), textureSize(shadow_map, 0).xy - 1);
  float depth = map_depth(query, texel);
  bool hiding = blocks(depth, min(query_depth(query, vec2(texel) + 0.5), own_depth));
  return hiding ? magnification(receiver.depth - surface_depth(query.view, depth)) : 0.0;
}
float magnification_at(ivec2 tap) { return magnification_of(texel_of(grid, tap)); }

uint weight_of(LightMask points) {
  uint sum = 0u;
  for (int plane = 0; plane < MASK_PLANES; ++plane) {
    uint count = 0u;
    for (int w = 0; w < MASK_WORDS; ++w) count += uint(bitCount(points.words[w] & planes[plane * MASK_WORDS + w]));
    sum += count << plane;
  }
  return sum;
}

void hide_patch(vec2 low, vec2 high) {
#if OVERLAP == OVERLAP_MASK
  hide(mask, low, high);
#else
  LightMask patch_mask = empty_mask();
  hide(patch_mask, low, high);
  overlapping += weight_of(patch_mask);
#endif
}

bool reaches(float own, float other) {
  return other > 0.0 && params.gap > 0.0 && is_one_surface(receiver, query, own, other, params.gap * float(grid.stride));
}

// Patch of the texels from `low` to `high`, whose neighbours at the left and above are `left` and `above`, 0: none.
void hide_texels(vec2 low, vec2 high, float own, float left, float above) {
  const float MIDDLE = 0.5 * float(MASK_SIDE);
  vec2 a = (low - query.position) * receiver.scale, b = (high - query.position) * receiver.scale;
  vec2 from = a * own, to = b * own;
  if (reaches(own, left)) from.x = min(from.x, a.x * left), to.x = max(to.x, a.x * left);
  if (reaches(own, above)) from.y = min(from.y, a.y * above), to.y = max(to.y, a.y * above);
  hide_patch(from + MIDDLE, to + MIDDLE);
}

bool rbsm_lit(ivec2 tap, inout float lowering) { return true; }  // nothing is walked
bool tap_lit(ivec2 tap) { return !hides(texel_of(grid, tap)); }
// Of a grid with a tap a texel: the tap, and those at its right, below and diagonally below, in the order of a gather.
vec4 quad_lit(ivec2 tap) {
  ivec2 size = textureSize(shadow_map, 0).xy, texel = texel_of(grid, tap);
  vec4 depths = textureGather(shadow_map, vec3(vec2(texel + 1) / vec2(size), query.layer));
  vec2 low = vec2(clamp(texel, ivec2(0), size - 1)) + 0.5, high = vec2(clamp(texel + 1, ivec2(0), size - 1)) + 0.5;
  vec4 plane = receiver_depths(query.view, query.plane, vec4(low.x, high.x, high.x, low.x), vec4(high.y, high.y, low.y, low.y),
                               ENCODING == ENCODING_LINEAR);
  return vec4(lessThanEqual(min(plane, vec4(own_depth)), depths));
}
#include "lib/revectorization.glsl"
#include "lib/silhouette_bits.glsl"

#include "soft/back_projection_coarse.glsl"
#if SILHOUETTE == SILHOUETTE_REVECTORIZED
#include "soft/back_projection_cut.glsl"
#else

void hide_fine() {
  float above[MOST_TAPS];
  for (int x = 0; x < MOST_TAPS; ++x) above[x] = 0.0;
  int y = 0;
  do {
    float left = 0.0;
    int x = 0;
    do {
      float own = magnification_at(ivec2(x, y));
      vec2 low = low_of(grid, ivec2(x, y));
      if (own > 0.0) hide_texels(low, low + 1.0, own, left, above[x]);
      left = above[x] = own;
    } while (++x < grid.taps.x);
  } while (++y < grid.taps.y && !is_full(mask));
}

#endif

// Grid by grid, until one covers the region.
void hide_region(Region region) {
  ivec2 own = ivec2(floor(query.position)), reach = max(region.high - own, own - region.low) + 1;
  grid = grid_over(region, own, 1);
  hide_fine();
  for (int stride = 2; stride * params.taps / 4 < max(reach.x, reach.y) && !is_full(mask); stride *= 2) {
    grid = grid_over(region, own, stride);
    hide_coarse();
  }
}

float visible_share(uint total) {
#if OVERLAP == OVERLAP_MASK
  return 1.0 - float(weight_of(mask)) / float(total);
#else
  return 1.0 - float(min(weight_of(mask) + overlapping, total)) / float(total);
#endif
}

// Of the light's points, by their weights.
float visible_part(Light light, Region region, Horizon horizon) {
  receiver = back_projection(query, light);
  own_depth = receiver_own_depth(query, receiver);
  mask = empty_mask();
  overlapping = 0u;
  const uint LIGHT_WORDS = uint(1 + MASK_PLANES * MASK_WORDS);  // of `weights`
  for (int i = 0; i < MASK_PLANES * MASK_WORDS; ++i) planes[i] = weights[push.light * LIGHT_WORDS + 1u + uint(i)];
  if (crosses_light(horizon)) hide_half_plane(mask, horizon.height, horizon.slope / (0.5 * float(MASK_SIDE)));
  if (region.blocks || SILHOUETTE == SILHOUETTE_REVECTORIZED) hide_region(region);
  return visible_share(weights[push.light * LIGHT_WORDS]);
}

void main() {
  ivec2 at;
  if (!listed_pixel(list_slot(), imageSize(visibility).x, at)) return;
  make_query(at, query);
  Light light = lights[push.light];
  Region region = find_region(query, light);
  Horizon horizon = horizon_at(at, query.view, half_size_of(light));
  float v = visible_part(light, region, horizon);
  float plain = imageLoad(visibility, ivec3(at, push.light)).x;  // where all pixels are listed
  if (plain != UNDECIDED) v = plain;
  imageStore(visibility, ivec3(at, push.light), vec4(v));
}
