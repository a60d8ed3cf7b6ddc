// RBSM, first half: the shadow test of every pixel (3.2), and the list of pixels that lie on the silhouette (3.3).
// Only these are walked: the work follows the pixels that need it.
#include "pixel_list.glsl"
#include "shadow_query.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(visibility).xy;
  if (any(greaterThanEqual(at, size))) return;
  Query query;
  int state = make_query(at, query);
  ivec2 texel = ivec2(floor(query.position));
  bvec4 neighbours;
  bool lit = is_lit_cross(query, texel, neighbours);
  bool same = lit ? all(neighbours) : !any(neighbours);
  bool inside = state == PIXEL_INSIDE;
  imageStore(visibility, ivec3(at, push.light), vec4(inside ? float(lit) : unmapped_visibility(state)));
  // The conservative form works on the lit side only.
  bool wanted = MODE == MODE_CONSERVATIVE ? lit : true;
  if (inside && !same && wanted) list_pixel(at, size.x);
}
