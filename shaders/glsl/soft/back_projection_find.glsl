// Back-projection, first half: pixels that the min-max pyramid tells to see all of the light or nothing of it are done; the others
// are listed.
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"
#include "map/light_kernel.glsl"
#include "map/search_region.glsl"
#include "map/back_projection.glsl"
#include "map/horizon.glsl"
#include "map/plain_window.glsl"
#include "soft/back_projection_plain.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(visibility).xy;
  if (any(greaterThanEqual(at, size))) return;
  Query query;
  int state = make_query(at, query);
  float v = unmapped_visibility(state);
  if (state == PIXEL_INSIDE) {
    Light light = lights[push.light];
    if (size_of(light) == 0.0) {
      v = is_lit(query, ivec2(floor(query.position))) ? 1.0 : 0.0;
    } else {
      int plain = plainly(query, light, horizon_at(at, query.view, half_size_of(light)), find_region(query, light));
      v = plain == PLAINLY_LIT ? 1.0 : plain == PLAINLY_DARK ? 0.0 : UNDECIDED;
      if (plain == MIXED || KEEP_ALL == 1) list_pixel(at, size.x);
    }
  }
  imageStore(visibility, ivec3(at, push.light), vec4(v));
}
