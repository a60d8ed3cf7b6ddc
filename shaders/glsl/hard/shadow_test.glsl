// Williams' shadow test (Macedo 2018, eq. 3.2).
#include "map/shadow_query.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(visibility).xy))) return;
  Query query;
  int state = make_query(at, query);
  bool lit = is_lit(query, ivec2(floor(query.position)));
  imageStore(visibility, ivec3(at, push.light), vec4(state == PIXEL_INSIDE ? float(lit) : unmapped_visibility(state)));
}
