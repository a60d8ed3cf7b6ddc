// Penumbrae on the screen (Macedo 2018, ch. 5.4, in the form that is geometrically right): the mean of the source over the kernel
// (G8), which is a scaled copy of the light in the plane through the receiver parallel to it, seen through the receiver's tangent
// plane. Only the receiver's own surface counts.
#include "screen/screen_kernel.glsl"
#include "frame/pixel_list.glsl"

layout(push_constant) uniform Push { int layer; float reach; } push;
layout(local_size_x = 64) in;

// At `place` of the kernel's square [-1, 1]^2. The Gaussian is cut off at the square's border.
float weight_of(vec2 place) {
#if KERNEL == KERNEL_GAUSSIAN
  return exp(-0.5 * CUT_OFF * CUT_OFF * dot(place, place));
#else
  return 1.0;
#endif
}

float penumbra_at(ivec2 at, Receiving here, SurfaceKernel kernel) {
  Light light = lights[light_of(push.layer)];
  int taps = taps_over(kernel_bounds(kernel, push.reach), params.taps);
  vec2 sum = vec2(0.0);
  int y = 0;
  do {
    int x = 0;
    do {
      vec2 place = lattice_point(x, y, taps);
      if (kernel.round_light && KERNEL != KERNEL_GAUSSIAN) place = disc_of_square(place);
      ivec2 pixel;
      if (!above(kernel.horizon, push.reach * place))
        sum.y += weight_of(place);
      else if (kernel_pixel(kernel, here, light, push.reach * place, push.reach, pixel))
        sum += weight_of(place) * vec2(source_at(pixel, push.layer).x, 1.0);
    } while (++x < taps);
  } while (++y < taps);
  return sum.y > 0.0 ? sum.x / sum.y : source_at(at, push.layer).x;
}

void main() {
  ivec2 at;
  if (!listed_pixel(list_slot(), imageSize(visibility).x, at)) return;
  Receiving here = receiving_at(at, push.layer);
  SurfaceKernel kernel = kernel_of(here, push.layer, width_at(at, push.layer).x);
  imageStore(visibility, ivec3(at, push.layer), vec4(clamp(penumbra_at(at, here, kernel), 0.0, share_above(kernel.horizon, kernel.round_light))));
}
