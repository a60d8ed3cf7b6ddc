// RBSSM, second half (Macedo 2018, algorithm 5): the mean of the filtered revectorization (4.2) over the kernel, for the listed pixels.
//
// Taps stand at places of their own between the texels, so that each meets the revectorized silhouette elsewhere: with whole texels
// between them, as RPCF has it, all would meet it alike. Taps for points of the light below the receiver's horizon are in shadow.
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"
#include "map/light_kernel.glsl"
#include "map/horizon.glsl"
#include "soft/revectorized_penumbra_kernel.glsl"

layout(local_size_x = 64) in;

// Taps of a grid over the kernel, whose bits tell where silhouettes end: a texel each, or as many as make the kernel no wider than
// MOST_TAPS.
struct Grid {
  ivec2 low, stride, taps;
};
Query query;
Grid grid;

Grid grid_over(vec2 half_width) {
  ivec2 low = ivec2(floor(query.position - half_width)), texels = ivec2(floor(query.position + half_width)) - low + 1;
  Grid grid;
  grid.stride = (texels + MOST_TAPS - 1) / MOST_TAPS;
  grid.taps = (texels + grid.stride - 1) / grid.stride;
  grid.low = low;
  return grid;
}

bool tap_lit(ivec2 tap) {
  return is_lit(query, clamp(grid.low + tap * grid.stride + grid.stride / 2, ivec2(0), textureSize(shadow_map, 0).xy - 1));
}
vec4 quad_lit(ivec2 tap) { return lit_quad(query, grid.low + tap); }
bool rbsm_lit(ivec2 tap, inout float lowering) { return true; }  // nothing is walked
#include "lib/revectorization.glsl"
#include "lib/silhouette_bits.glsl"

float revectorized_at(vec2 place) {
  // The texel that a tap reads is in the middle of the tap.
  vec2 in_taps = (place - vec2(grid.low + grid.stride / 2) - 0.5) / vec2(grid.stride) + 0.5;
  ivec2 tap = clamp(ivec2(floor(in_taps)), ivec2(-1), grid.taps);
  bool lit = bit_lit(tap);
  bvec4 d = bit_discontinuity(tap, lit);
  if (!((d.x || d.y) && (d.z || d.w))) return lit ? 1.0 : 0.0;  // (4.2) without both is the plain test
  Runs runs = bit_runs(tap, lit, d);
  vec2 c = clamp(in_taps - vec2(tap), 0.0, 1.0);
  vec4 distances = vec4(run_distance(runs.left, c.x), run_distance(runs.right, 1.0 - c.x), run_distance(runs.top, c.y),
                        run_distance(runs.bottom, 1.0 - c.y));
  return rbsm_filtered(lit, rbsm_relative_position_filtered(distances, params.max_size));
}

void main() {
  ivec2 at;
  if (!listed_pixel(list_slot(), imageSize(visibility).x, at)) return;
  make_query(at, query);
  Light light = lights[push.light];
  vec2 half_width = half_kernel_at(at, query, light);
  grid = grid_over(half_width);
  if (grid.stride == ivec2(1)) read_window_by_quads(grid.taps);
  else read_window(grid.taps);
  Horizon horizon = horizon_at(at, query.view, half_size_of(light));
  bool round_light = is_round(light);
  float sum = 0.0;
  int y = 0;
  do {
    int x = 0;
    do {
      vec2 place = lattice_point(x, y, params.taps);
      if (round_light) place = disc_of_square(place);
      if (above(horizon, place)) sum += revectorized_at(query.position + half_width * place);
    } while (++x < params.taps);
  } while (++y < params.taps);
  imageStore(visibility, ivec3(at, push.light), vec4(clamp(sum / float(params.taps * params.taps), 0.0, 1.0)));
}
