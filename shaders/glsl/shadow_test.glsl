// Williams' shadow test (Macedo 2018, eq. 3.2).
#include "shadow_query.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at.xy, imageSize(visibility).xy))) return;
  Query query;
  int state = make_query(at.xy, at.z, query);
  bool lit = is_lit(query, ivec2(floor(query.position)));
  imageStore(visibility, at, vec4(state == PIXEL_INSIDE ? float(lit) : unmapped_visibility(state)));
}
