// RBSSM, first half (Macedo 2018, algorithm 5): pixels whose kernel is all lit or all in umbra by the min-max pyramid (5.4) are done;
// those in the penumbra are listed.
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"
#include "map/light_kernel.glsl"
#include "map/horizon.glsl"
#include "map/plain_window.glsl"
#include "soft/revectorized_penumbra_kernel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Of all texels that the kernel touches, and one around them, which silhouettes are told by.
int plainly(Query query, vec2 half_width) {
  return plain_window(query, ivec2(floor(query.position - half_width)) - 1, ivec2(floor(query.position + half_width)) + 1);
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(visibility).xy;
  if (any(greaterThanEqual(at, size))) return;
  Query query;
  int state = make_query(at, query);
  float v = unmapped_visibility(state);
  if (state == PIXEL_INSIDE) {
    Light light = lights[push.light];
    vec2 half_width = half_kernel_at(at, query, light);
    int plain = KEEP_ALL == 1 || crosses_light(horizon_at(at, query.view, half_size_of(light))) ? MIXED : plainly(query, half_width);
    v = plain == PLAINLY_LIT ? 1.0 : 0.0;
    if (plain == MIXED) list_pixel(at, size.x);
  }
  imageStore(visibility, ivec3(at, push.light), vec4(v));
}
