// Blocker search, first half: receivers that nothing may hide the light from, as a few blocks of the pyramid tell, have no blocker and
// no penumbra; the others are listed.
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"
#include "map/light_kernel.glsl"
#include "map/search_region.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), pixels = imageSize(blocker).xy;
  if (any(greaterThanEqual(at, pixels))) return;
  Query query;
  int state = make_query(at, query);
  Light light = lights[push.light];
  float size = size_of(light);
  bool blocks = first_region(kernel_query(query), half_size_of(light), size).blocks;
  imageStore(blocker, ivec3(at, push.light), vec4(NO_BLOCKER));
  imageStore(width, ivec3(at, push.light), vec4(0.0));
  if (state == PIXEL_INSIDE && size > 0.0 && blocks) list_pixel(at, pixels.x);
}
