// Percentage-closer filtering with a width of its own for every pixel (Fernando 2005): the mean of the shadow tests over the
// kernel that the light is seen through, which is a scaled copy of it, of the listed pixels. Every tap is tested against the
// receiver's plane there.
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"
#include "map/light_kernel.glsl"
#include "filtered/soft_kernel.glsl"
#include "lib/vogel_disc.glsl"

layout(local_size_x = 64) in;

const float TURN = 6.28318531;  // radians

// How much of a texel's width lies between `begin` and `end`.
vec2 covered(vec2 texel, vec2 begin, vec2 end) { return max(min(texel + 1.0, end) - max(texel, begin), vec2(0.0)); }

// What of the light four texels stand for that is above the horizon, as lit_quad() orders them. `first`: the middle of the upper left
// one in the kernel, which is the square [-1, 1]^2; `texel`: their size there.
vec4 quad_above(Horizon horizon, vec2 first, vec2 texel) {
  float reach = max(0.5 * dot(abs(horizon.slope), texel), 1e-30);
  vec4 x = first.x + vec4(0.0, texel.x, texel.x, 0.0), y = first.y + vec4(texel.y, texel.y, 0.0, 0.0);
  return clamp(0.5 + (0.5 / reach) * (horizon.slope.x * x + horizon.slope.y * y + horizon.height), 0.0, 1.0);
}

// All texels of a box, those on its border in part. On an axis on which it has no width, its middle's texel.
float box(Query query, vec2 half_width, Horizon horizon) {
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
      vec4 lit = lit_quad(query, ivec2(x, y)) * quad_above(horizon, (vec2(x, y) + 0.5 - query.position) / half_width, 1.0 / half_width);
      vec4 weight = vec4(wx.x, wx.y, wx.y, wx.x) * vec4(wy.y, wy.y, wy.x, wy.x);
      sum += dot(weight, lit);
      weights += weight.x + weight.y + weight.z + weight.w;
    } while ((x += 2) <= last.x);
  } while ((y += 2) <= last.y);
  return sum / weights;
}

// Is the map lit at a place of the kernel, which is the square [-1, 1]^2?
float tap(Query query, vec2 place, vec2 half_width, bool round_light, Horizon horizon) {
  if (round_light) place = disc_of_square(place);
  vec2 at = query.position + half_width * place;
  ivec2 last = textureSize(shadow_map, 0).xy - 1;
  return is_lit(query, clamp(ivec2(floor(at)), ivec2(0), last)) && above(horizon, place) ? 1.0 : 0.0;
}

// How much the part of the light counts that a place of the kernel stands for (UNEVEN: some counts more than others).
float weight_at(vec2 place) {
#if UNEVEN == 1
  ivec2 cell = clamp(ivec2((0.5 + 0.5 * place) * float(CELLS)), ivec2(0), ivec2(CELLS - 1));
  return cells[(int(push.light) * CELLS + cell.y) * CELLS + cell.x];
#else
  return 1.0;
#endif
}

float kernel_mean(Query query, ivec2 pixel, vec2 half_width, bool round_light, Horizon horizon) {
  float sum = 0.0, weights = 0.0;
#if SAMPLING == SAMPLING_VOGEL
  float rotation = ROTATE == 1 ? TURN * interleaved_gradient_noise(pixel) : 0.0;
  int i = 0;
  do {
    vec2 place = square_of_disc(vogel_point(i, params.samples, rotation));
    float weight = weight_at(place);
    sum += weight * tap(query, place, half_width, round_light, horizon);
    weights += weight;
  } while (++i < params.samples);
#else
  bool texels = UNEVEN == 0 && !round_light && max(half_width.x, half_width.y) * 2.0 <= float(params.taps);
  if (texels) return box(query, half_width, horizon);
  int y = 0;
  do {
    int x = 0;
    do {
      vec2 place = lattice_point(x, y, params.taps);
      float weight = weight_at(place);
      sum += weight * tap(query, place, half_width, round_light, horizon);
      weights += weight;
    } while (++x < params.taps);
  } while (++y < params.taps);
#endif
  return weights > 0.0 ? sum / weights : 0.0;
}

void main() {
  ivec2 at;
  if (!listed_pixel(list_slot(), imageSize(visibility).x, at)) return;
  Query query;
  make_query(at, query);
  SoftKernel kernel = soft_kernel(query, at, lights[push.light]);
  float v = kernel_mean(kernel_query(query), at, kernel.half_width, kernel.round_light, kernel.horizon);
  imageStore(visibility, ivec3(at, push.light), vec4(clamp(v, 0.0, kernel.most_lit)));
}
