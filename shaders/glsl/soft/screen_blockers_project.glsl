// The shadow map, projected to the screen once: the linear depth of what hides each pixel from the light's centre.
#include "map/shadow_query.glsl"
#include "map/light_kernel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(occluder).xy))) return;
  Query query;
  float z = NO_BLOCKER;
  if (make_query(at, query) == PIXEL_INSIDE) {
    query = kernel_query(query);
    ivec2 texel = ivec2(floor(query.position));
    if (!is_lit(query, texel)) z = linear_depth(query.view, map_depth(query, texel));
  }
  imageStore(occluder, ivec3(at, push.light), vec4(z));
}
