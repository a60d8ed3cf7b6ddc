// All pixels but the background, for compose.glsl, with the first lights as flat inputs.
#define PIXEL_RAYS_OUT
#include "frame/pixel_rays.glsl"

layout(location = PIXEL_RAYS) flat out vec4 flat_lights[4 * FLAT_LIGHTS];

void main() {
  gl_Position = triangle_behind_all();
  make_pixel_rays();
  for (int i = 0; i < FLAT_LIGHTS; ++i) {
    flat_lights[4 * i] = lights[i].position;
    flat_lights[4 * i + 1] = lights[i].direction;
    flat_lights[4 * i + 2] = lights[i].intensity;
    flat_lights[4 * i + 3] = lights[i].cone;
  }
}
