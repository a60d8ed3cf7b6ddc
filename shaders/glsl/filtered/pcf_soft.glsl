// Percentage-closer filtering with a width of its own for every pixel (Fernando 2005): the mean of the shadow tests over the
// kernel that the light is seen through, which is a scaled copy of it. Every tap is tested against the receiver's plane there.
#include "map/shadow_query.glsl"
#include "map/light_kernel.glsl"
#include "lib/vogel_disc.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const float TURN = 6.28318531;  // radians

// How much of a texel's width lies between `begin` and `end`.
vec2 covered(vec2 texel, vec2 begin, vec2 end) { return max(min(texel + 1.0, end) - max(texel, begin), vec2(0.0)); }

// All texels of a box, those on its border in part. On an axis on which it has no width, its middle's texel.
float box(Query query, vec2 half_width) {
  vec2 begin = query.position - half_width, end = query.position + half_width, own = floor(query.position);
  bvec2 none = lessThanEqual(end - begin, vec2(0.0));
  begin = mix(begin, own, none);
  end = mix(end, own + 1.0, none);
  ivec2 first = ivec2(floor(begin)), last = ivec2(ceil(end)) - 1;
  float sum = 0.0, weights = 0.0;
  int y = first.y;
  do {
    vec2 wy = vec2(covered(vec2(y), begin, end).y, covered(vec2(y + 1), begin, end).y);
    int x = first.x;
    do {
      vec2 wx = vec2(covered(vec2(x), begin, end).x, covered(vec2(x + 1), begin, end).x);
      vec4 lit = lit_quad(query, ivec2(x, y)), weight = vec4(wx.x, wx.y, wx.y, wx.x) * vec4(wy.y, wy.y, wy.x, wy.x);
      sum += dot(weight, lit);
      weights += weight.x + weight.y + weight.z + weight.w;
    } while ((x += 2) <= last.x);
  } while ((y += 2) <= last.y);
  return sum / weights;
}

// Is the map lit at a place of the kernel, which is the square [-1, 1]^2?
float tap(Query query, vec2 place, vec2 half_width, bool round_light) {
  vec2 at = query.position + half_width * (round_light ? disc_of_square(place) : place);
  ivec2 last = textureSize(shadow_map, 0).xy - 1;
  return is_lit(query, clamp(ivec2(floor(at)), ivec2(0), last)) ? 1.0 : 0.0;
}

float kernel_mean(Query query, ivec2 pixel, vec2 half_width, bool round_light) {
  float sum = 0.0;
#if SAMPLING == SAMPLING_VOGEL
  float rotation = ROTATE == 1 ? TURN * interleaved_gradient_noise(pixel) : 0.0;
  int i = 0;
  do {
    sum += tap(query, square_of_disc(vogel_point(i, params.samples, rotation)), half_width, round_light);
  } while (++i < params.samples);
  return sum / float(params.samples);
#else
  if (!round_light && max(half_width.x, half_width.y) * 2.0 <= float(params.taps)) return box(query, half_width);
  int y = 0;
  do {
    int x = 0;
    do {
      sum += tap(query, lattice_point(x, y, params.taps), half_width, round_light);
    } while (++x < params.taps);
  } while (++y < params.taps);
  return sum / float(params.taps * params.taps);
#endif
}

#ifdef HAS_PYRAMID
// Of all texels that the kernel touches.
int plainly(Query query, vec2 half_width) {
  ivec2 low = ivec2(floor(query.position - half_width)), high = ivec2(floor(query.position + half_width));
  return min_max_compare(plane_range(query, low, high), pyramid_range(low, high, query.layer));
}
#endif

float soft(Query query, ivec2 pixel) {
  Light light = lights[push.light];
  float penumbra = width_at(pixel, int(push.light)).x;
  vec2 most = vec2(map_size());  // beyond which the map's border is repeated anyway
  vec2 half_width = min(half_kernel(query.view, half_size_of(light), size_of(light), penumbra, query.plane.z), most);
  if (half_width == vec2(0.0)) return is_lit(query, ivec2(floor(query.position))) ? 1.0 : 0.0;
#ifdef HAS_PYRAMID
  int plain = KEEP_ALL == 1 ? MIXED : plainly(query, half_width);
  if (plain != MIXED) return plain == PLAINLY_LIT ? 1.0 : 0.0;
#endif
  return kernel_mean(query, pixel, half_width, is_round(light));
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(visibility).xy))) return;
  Query query;
  int state = make_query(at, query);
  float v = state == PIXEL_INSIDE ? clamp(soft(query, at), 0.0, 1.0) : unmapped_visibility(state);
  imageStore(visibility, ivec3(at, push.light), vec4(v));
}
