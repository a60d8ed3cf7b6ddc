// What blockers and penumbrae are in a light's map: lib/soft_shadow.glsl for the receiver of a query. After
// map/shadow_query.glsl.
#include "lib/light_shape.glsl"
#include "lib/min_max.glsl"
#include "lib/soft_shadow.glsl"

// Half width and height of the light: world units; of a directional light, tangents.
vec2 half_size_of(Light light) { return is_directional(light) ? vec2(light.size.w) : light.size.xy; }
// Its larger side, by which widths of penumbrae count.
float size_of(Light light) {
  vec2 half_size = half_size_of(light);
  return 2.0 * max(half_size.x, half_size.y);
}
bool is_round(Light light) { return light.size.z == SHAPE_DISC || light.size.z == SHAPE_SPHERE; }

float linear_depth(LightView view, float encoded) {
  return ENCODING == ENCODING_LINEAR || is_orthographic(view) ? decode_linear(view, encoded) : decode_perspective(view, encoded);
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
const int FINER = 2;  // levels: 4 to 5 blocks on an axis, which reach beyond the texels by less than half of them

// Least and greatest depth of blocks of the pyramid that hold the texels from `low` to `high`, cut off at the map.
vec2 pyramid_range(ivec2 low, ivec2 high, int layer) {
  ivec2 last = textureSize(shadow_map, 0).xy - 1;
  low = clamp(low, ivec2(0), last);
  high = clamp(high, ivec2(0), last);
  ivec2 texels = high - low + 1;
  int level = clamp(pyramid_level(max(texels.x, texels.y)) - FINER, 0, textureQueryLevels(pyramid) - 1);
  // Not textureSize() of the level: lavapipe answers all invocations of a subgroup with that of the first.
  ivec2 blocks = max(textureSize(pyramid, 0).xy >> level, ivec2(1));
  ivec2 from = pyramid_block(low, level, blocks), to = pyramid_block(high, level, blocks);
  vec2 range = vec2(1.0, 0.0);
  int y = from.y;
  do {
    int x = from.x;
    do {
      range = min_max_join(range, pyramid_at(ivec2(x, y), layer, level).xy);
    } while (++x <= to.x);
  } while (++y <= to.y);
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
