// RPCF, first half: pixels whose kernel and its neighbours are all lit or all in shadow have no silhouette to revectorize and
// are done; the others are listed. Without LIST, as the naive algorithm has it, all are.
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"
#include "filtered/rpcf_kernel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(visibility).xy;
  if (any(greaterThanEqual(at, size))) return;
  Query query;
  int state = make_query(at, query);
  int kernel = kernel_at(at, query);
  ivec2 first = ivec2(floor(query.position)) - kernel / 2 - 1;
  // kernel + 2 texels a side, which is odd: the last quad takes in one more, which must not count.
  vec4 least = vec4(1.0), most = vec4(0.0);
  int width = LIST == 1 && KEEP_ALL == 0 ? kernel + 2 : 0;
  for (int y = 0; y < width; y += 2)
    for (int x = 0; x < width; x += 2) {
      vec4 lit = lit_quad(query, first + ivec2(x, y));
      if (x > kernel) lit.yz = lit.xw;
      if (y > kernel) lit.xy = lit.wz;
      least = min(least, lit);
      most = max(most, lit);
    }
#if LIST == 0 || KEEP_ALL == 1
  least.x = 0.0;
  most.x = 1.0;
#endif
  bool any_lit = any(greaterThan(most, vec4(0.5))), all_lit = all(greaterThan(least, vec4(0.5)));
  bool inside = state == PIXEL_INSIDE;
  imageStore(visibility, ivec3(at, push.light), vec4(inside ? float(any_lit) : unmapped_visibility(state)));
  if (inside && any_lit != all_lit) list_pixel(at, size.x);
}
