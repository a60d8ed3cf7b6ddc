// Width of RPCF's kernel, texels, odd: the same everywhere, or with a width of its own for every pixel (Macedo 2018, algorithm 5)
// that of the penumbra, rounded to whole odd texels and `kernel` at most. After map/shadow_query.glsl.
#ifdef HAS_WIDTH
#include "map/light_kernel.glsl"

int kernel_at(ivec2 pixel, Query query) {
  Light light = lights[push.light];
  vec2 half_width = half_kernel(query.view, half_size_of(light), size_of(light), width_at(pixel, int(push.light)).x, query.plane.z);
  return clamp(2 * int(max(half_width.x, half_width.y)) + 1, 1, params.kernel);
}
#else
int kernel_at(ivec2 pixel, Query query) { return params.kernel; }
#endif
