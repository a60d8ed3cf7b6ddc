// Filters with a width for each pixel, first half: pixels without a penumbra, and those of which all of the kernel is lit or in umbra, are
// done; the others are listed. PLAIN_DECIDES: the filter itself would say something else of these, so that nothing may skip the look.
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"
#include "map/light_kernel.glsl"
#include "filtered/soft_kernel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef HAS_PYRAMID
// Of all texels that the kernel touches.
int plainly(Query query, vec2 half_width) {
  ivec2 low = ivec2(floor(query.position - half_width)), high = ivec2(floor(query.position + half_width));
  return min_max_compare(plane_range(query, low, high), pyramid_range(low, high, query.layer));
}
#endif

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), pixels = imageSize(visibility).xy;
  if (any(greaterThanEqual(at, pixels))) return;
  Query query;
  int state = make_query(at, query);
  Light light = lights[push.light];
  SoftKernel kernel = soft_kernel(query, at, light);
  bool inside = state == PIXEL_INSIDE, sized = size_of(light) > 0.0, partly = inside && sized && kernel.penumbra > 0.0;
  if (sized) query = kernel_query(query);
  bool lit = is_lit(query, ivec2(floor(query.position)));
#ifdef HAS_PYRAMID
  int plain = KEEP_ALL == 1 && PLAIN_DECIDES == 0 ? MIXED : plainly(query, kernel.half_width);
  if (partly) lit = plain != PLAINLY_DARK;
  partly = partly && plain == MIXED;
#endif
  float v = lit ? (sized ? kernel.most_lit : 1.0) : 0.0;
  imageStore(visibility, ivec3(at, push.light), vec4(inside ? v : unmapped_visibility(state)));
  if (partly) list_pixel(at, pixels.x);
}
