// All pixels but the background, for shadow_test.glsl, with the light and the only view that it may have as flat inputs.
#define PIXEL_RAYS_OUT
#include "frame/pixel_rays.glsl"
#include "map/shadow_query.glsl"

layout(location = PIXEL_RAYS) flat out vec4 flat_light[2];
#if LIGHT_VIEWS == 1
layout(location = PIXEL_RAYS + 2) flat out vec4 flat_view[5];
#endif

void main() {
  gl_Position = triangle_behind_all();
  make_pixel_rays();
  flat_light[0] = lights[push.light].position;
  flat_light[1] = lights[push.light].direction;
#if LIGHT_VIEWS == 1
  LightView view = views[push.view];
  for (int i = 0; i < 3; ++i) flat_view[i] = view.rows[i];
  flat_view[3] = view.range;
  flat_view[4] = vec4(view.info);
#endif
}
