// What blockers and penumbrae are in a light's map: lib/soft_shadow.glsl for the receiver of a query. After
// map/shadow_query.glsl.
#include "frame/light_size.glsl"
#include "lib/light_shape.glsl"
#include "lib/min_max.glsl"
#include "lib/soft_shadow.glsl"

// What the tangent plane of the pixel's surface hides of the light, whose shape is scaled to the square [-1, 1]^2.
Horizon horizon_at(ivec2 pixel, LightView view, vec2 half_size) {
  vec3 position = relative_position(pixel, depth_at(pixel).x), normal = octahedral_decode(geometric_at(pixel).xy);
  return receiver_horizon(view, position, normal, half_size);
}

float linear_depth(LightView view, float encoded) {
  return ENCODING == ENCODING_LINEAR || is_orthographic(view) ? decode_linear(view, encoded) : decode_perspective(view, encoded);
}

// For tests over many texels: a kernel that meets a crease of the receiver's own surface, which no texel resolves, is to take it for
// a part of the receiver. Further shift of the plane that is followed, texels.
const float KERNEL_SHIFT = 1.0, KERNEL_SHIFT_SLOPE = 0.1;
Query kernel_query(Query query) {
#if BIAS == BIAS_RECEIVER_PLANE
  float texel = texel_world_size(query.view, query.plane.z, map_size()), slope = query.plane.slope;
  float further = texel * (KERNEL_SHIFT + KERNEL_SHIFT_SLOPE * slope);
  query.plane = bias_receiver(query.view, query.plane, bias_world(texel, slope) + further);
#endif
  return query;
}

// World units, at the receiver.
float penumbra_of_blocker(LightView view, float size, float z_p, float z_b) {
  return is_orthographic(view) ? directional_penumbra_width(size, z_p, z_b) : penumbra_width(size, z_p, z_b);
}
// Half axes, in texels, of the kernel in the map: a scaled copy of the light. `half_size`: that of a light with a penumbra of the
// width `penumbra` and a larger side of `size`.
vec2 half_kernel(LightView view, vec2 half_size, float size, float penumbra, float z_p) {
  vec2 penumbrae = half_size * (size > 0.0 ? penumbra / size : 0.0);  // half of that of each axis
  vec2 on_plane = is_orthographic(view) ? penumbrae : penumbrae / z_p;  // world units, or tangents: the plane at depth 1
  return 0.5 * map_size() * on_plane / view.range.zw;
}

#ifdef HAS_PYRAMID
// Of four neighbouring invocations lavapipe reads for all the level that the first of them asks for, even where that one takes no
// part any more: so levels are asked for by constants.
#define EACH_LEVEL(range_of) \
  range_of(0) range_of(1) range_of(2) range_of(3) range_of(4) range_of(5) range_of(6) range_of(7) range_of(8) range_of(9) range_of(10) \
  range_of(11) range_of(12) range_of(13)
const int FINER = 2;  // levels: 4 to 5 blocks on an axis, which reach beyond the texels by less than half of them

// The blocks of a level of the pyramid that hold some texels.
struct PyramidBlocks {
  ivec2 first, last;
  int level;
};

// Of the texels from `low` to `high`, cut off at the map. `finer`: levels below the one of which at most 2 blocks on an axis hold
// them.
PyramidBlocks pyramid_blocks(ivec2 low, ivec2 high, int finer) {
  ivec2 last = textureSize(shadow_map, 0).xy - 1;
  low = clamp(low, ivec2(0), last);
  high = clamp(high, ivec2(0), last);
  ivec2 texels = high - low + 1;
  int level = clamp(pyramid_level(max(texels.x, texels.y)) - finer, 0, textureQueryLevels(pyramid) - 1);
  // Not textureSize() of the level: lavapipe answers all invocations of a subgroup with that of the first.
  ivec2 blocks = max(textureSize(pyramid, 0).xy >> level, ivec2(1));
  return PyramidBlocks(pyramid_block(low, level, blocks), pyramid_block(high, level, blocks), level);
}

// Least and greatest depth of blocks of the pyramid that hold the texels from `low` to `high`, cut off at the map.
vec2 pyramid_range(ivec2 low, ivec2 high, int layer) {
  PyramidBlocks blocks = pyramid_blocks(low, high, FINER);
  vec2 range = vec2(1.0, 0.0);
#define RANGE_OF(l)                                                                                             \
  for (int y = blocks.level == l ? blocks.first.y : blocks.last.y + 1; y <= blocks.last.y; ++y)                 \
    for (int x = blocks.first.x; x <= blocks.last.x; ++x) range = min_max_join(range, pyramid_at(ivec2(x, y), layer, l).xy);
  EACH_LEVEL(RANGE_OF)
  return range;
}

// The same of four blocks, which may reach farther.
vec2 rough_pyramid_range(ivec2 low, ivec2 high, int layer) {
  PyramidBlocks blocks = pyramid_blocks(low, high, 0);
  vec2 range = vec2(1.0, 0.0);
#define ROUGH_RANGE_OF(l)                                                                                       \
  for (int y = blocks.level == l ? 0 : 2; y < 2; ++y)                                                           \
    for (int x = 0; x < 2; ++x)                                                                                 \
      range = min_max_join(range, pyramid_at(ivec2(x == 0 ? blocks.first.x : blocks.last.x, y == 0 ? blocks.first.y : blocks.last.y), layer, l).xy);
  EACH_LEVEL(ROUGH_RANGE_OF)
  return range;
}
#endif

// Least and greatest depth of the receiver's plane at the same texels, which are cut off as taps are.
vec2 plane_range(Query query, ivec2 low, ivec2 high) {
  ivec2 last = textureSize(shadow_map, 0).xy - 1;
  vec2 a = vec2(clamp(low, ivec2(0), last)) + 0.5, b = vec2(clamp(high, ivec2(0), last)) + 0.5;
  return min_max_of(receiver_depths(query.view, query.plane, vec4(a.x, b.x, b.x, a.x), vec4(b.y, b.y, a.y, a.y),
                                    ENCODING == ENCODING_LINEAR));
}
