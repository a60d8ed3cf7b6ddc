// RPCF, second half: the mean of the filtered revectorization (4.2) over the kernel, for the listed pixels (Macedo 2018,
// algorithm 2). The text divides by w; the number of samples is w^2.
//
// A dispatch does a part of the kernel, a block of samples or, without reuse, a row of a block, and hands the sum on: wide
// kernels with long walks would keep a device longer in one dispatch than drivers allow (lavapipe ends loops after 65535 iterations
// in all). Samples are added in the same order either way.
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"
#include "filtered/rpcf_kernel.glsl"

layout(local_size_x = 64) in;

Query query;
#ifdef HAS_WIDTH
int kernel;  // of the pixel at hand
#define KERNEL kernel
#else
#define KERNEL params.kernel
#endif

bool rbsm_lit(ivec2 texel, inout float lowering) {
  return is_lit(query, clamp(texel, ivec2(0), textureSize(shadow_map, 0).xy - 1));
}

#include "lib/revectorization.glsl"

float revectorized(bool lit, bvec4 d, vec4 distances) {
  return any(d) ? rbsm_filtered(lit, rbsm_relative_position_filtered(distances, params.max_size)) : float(lit);
}

// BLOCK: samples a side that are done together at most. push.part: the block in x and y, and above the latter's ROW_SHIFT bits
// its row.

// Blocks a side, and samples a side of a block; of the last ones some lie beyond the kernel and do not count.
int blocks() { return (KERNEL + BLOCK - 1) / BLOCK; }
int block_size() { return (KERNEL + blocks() - 1) / blocks(); }

#if REUSE == 1

#include "lib/silhouette_window.glsl"

const int WINDOW = BLOCK + 2;  // with their neighbours

// The silhouette that passes the window's last texel, walked on beyond it along `direction`. `sides`: the texel's
// discontinuities across the walk, towards -across and +across.
uint walk_beyond(ivec2 texel, ivec2 direction, bool lit, bvec2 sides) {
  ivec2 across = abs(direction.yx);
  bvec3 going = bvec3(sides, any(sides));
  Run runs[3] = Run[3](Run(0, false), Run(0, false), Run(0, false));
  float unused = 0.0;
  int steps = 0;
  if (going.z) {
    do {
      texel += direction;
      bool ends = rbsm_lit(texel, unused) != lit;
      bool a = rbsm_lit(texel - across, unused) != lit, b = rbsm_lit(texel + across, unused) != lit;
      bvec3 shares = bvec3(a, b, a || b);
      for (int k = 0; k < 3; ++k) {
        if (going[k] && ends) runs[k].found = true;
        going[k] = going[k] && !ends && shares[k];
        if (going[k]) ++runs[k].whole;
      }
    } while (any(going) && ++steps < params.max_size);
  }
  return pack_run(runs[0], 0u) | pack_run(runs[1], 1u) | pack_run(runs[2], 2u);
}

bool bit(uint line, int at) { return (line >> at & 1u) != 0u; }

// Adds the block of samples from `first` on, of which `inside` count, to `sum`; `c` is (3.1), the same for all of them.
float add_part(float sum, ivec2 first, ivec2 inside, vec2 c) {
  uint rows[WINDOW + 2], columns[WINDOW + 2];
  for (int i = 0; i < WINDOW + 2; ++i) rows[i] = columns[i] = 0u;
  ivec2 window = ivec2(block_size() + 2), origin = first - 1;
  int y = 0;
  do {
    int x = 0;
    do {
      uvec4 lit = uvec4(lit_quad(query, origin + ivec2(x, y)));
      rows[y] |= (lit.w | lit.z << 1) << x;
      rows[y + 1] |= (lit.x | lit.y << 1) << x;
      columns[x] |= (lit.w | lit.x << 1) << y;
      columns[x + 1] |= (lit.z | lit.y << 1) << y;
    } while ((x += 2) < window.x);
  } while ((y += 2) < window.y);
  uint above[WINDOW], below[WINDOW];
  ivec2 last = window - 1;
  for (int x = 1; x < last.x; ++x) {
    uint column = columns[x], differs_left = column ^ columns[x - 1], differs_right = column ^ columns[x + 1];
    above[x] = walk_beyond(origin + ivec2(x, 0), ivec2(0, -1), bit(column, 0), bvec2(bit(differs_left, 0), bit(differs_right, 0)));
    below[x] = walk_beyond(origin + ivec2(x, last.y), ivec2(0, 1), bit(column, last.y),
                           bvec2(bit(differs_left, last.y), bit(differs_right, last.y)));
  }
  for (int y = 1; y < last.y; ++y) {
    uint row = rows[y], up = row ^ rows[y - 1], down = row ^ rows[y + 1];
    uint before = walk_beyond(origin + ivec2(0, y), ivec2(-1, 0), bit(row, 0), bvec2(bit(up, 0), bit(down, 0)));
    uint after = walk_beyond(origin + ivec2(last.x, y), ivec2(1, 0), bit(row, last.x), bvec2(bit(up, last.x), bit(down, last.x)));
    for (int x = 1; x < last.x; ++x) {
      bool lit = bit(row, x);
      uint column = columns[x], left = column ^ columns[x - 1], right = column ^ columns[x + 1];
      bvec4 d = bvec4(bit(left, y), bit(right, y), bit(up, x), bit(down, x));
      uint same_row = lit ? row : ~row, same_column = lit ? column : ~column;
      uint shares_row = (d.z ? up : 0u) | (d.w ? down : 0u), shares_column = (d.x ? left : 0u) | (d.y ? right : 0u);
      int most = params.max_size;
      vec4 distances = vec4(run_distance(run_down(same_row, shares_row, x, before, d.z, d.w, most), c.x),
                            run_distance(run_up(same_row, shares_row, x, window.x, after, d.z, d.w, most), 1.0 - c.x),
                            run_distance(run_down(same_column, shares_column, y, above[x], d.x, d.y, most), c.y),
                            run_distance(run_up(same_column, shares_column, y, window.y, below[x], d.x, d.y, most), 1.0 - c.y));
      if (x <= inside.x && y <= inside.y) sum += revectorized(lit, d, distances);
    }
  }
  return sum;
}

#else

// Every sample walks for itself.
float add_part(float sum, ivec2 first, ivec2 inside, vec2 c) {
  for (int x = 0; x < block_size(); ++x) {
    ivec2 texel = first + ivec2(x, push.part.y >> ROW_SHIFT);
    float unused = 0.0;
    bool lit = rbsm_lit(texel, unused);
    bvec4 d = rbsm_discontinuity(texel, lit);
    float v = revectorized(lit, d, rbsm_distances(texel, c, lit, d, params.max_size));
    if (x < inside.x) sum += v;
  }
  return sum;
}

#endif

void main() {
  ivec2 at;
  if (!listed_pixel(list_slot(), imageSize(visibility).x, at)) return;
  make_query(at, query);
#ifdef HAS_WIDTH
  kernel = kernel_at(at, query);
#endif
  ivec2 part = ivec2(push.part & 0xFFu) * block_size(), inside = min(ivec2(KERNEL) - part, ivec2(block_size()));
#ifdef HAS_WIDTH
  if (any(lessThanEqual(inside, ivec2(0))) || int(push.part.y >> ROW_SHIFT) >= inside.y) return;  // of wider kernels
#endif
  ivec2 first = ivec2(floor(query.position)) - KERNEL / 2 + part;
  float before = push.part == uvec2(0) ? 0.0 : imageLoad(visibility, ivec3(at, push.light)).x;
  float sum = add_part(before, first, inside, fract(query.position));
  bool last = all(equal(part + inside, ivec2(KERNEL))) && (REUSE == 1 || int(push.part.y >> ROW_SHIFT) == inside.y - 1);
  float samples = float(KERNEL * KERNEL);
  imageStore(visibility, ivec3(at, push.light), vec4(last ? clamp(sum / samples, 0.0, 1.0) : sum));
}
