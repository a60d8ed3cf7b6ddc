// Mean depth of what hides some of a light, from what hides the pixels around from its centre (MohammadBagher et al. 2010; Macedo
// 2018, ch. 2.5.4), of the listed pixels. The region on the screen is that of (G3), which the pyramid shrinks, through (G8).
#include "frame/pixel_list.glsl"
#include "map/shadow_query.glsl"
#include "map/light_kernel.glsl"
#include "map/search_region.glsl"
#include "screen/screen_kernel.glsl"

layout(local_size_x = 64) in;

// x: sum of the depths; y: their number.
vec2 occluders_in(Receiving here, Light light, SurfaceKernel kernel) {
  int taps = taps_over(kernel_bounds(kernel, 1.0), params.taps);
  vec2 sum = vec2(0.0);
  int y = 0;
  do {
    int x = 0;
    do {
      ivec2 pixel;
      if (kernel_pixel(kernel, here, light, lattice_point(x, y, taps), 1.0, pixel)) {
        float z = imageLoad(occluder, ivec3(pixel, push.light)).x;
        if (z != NO_BLOCKER) sum += vec2(z, 1.0);
      }
    } while (++x < taps);
  } while (++y < taps);
  return sum;
}

float find_blocker(ivec2 at, Query query, Light light) {
  Region region = find_region(query, light);
  if (!region.blocks) return NO_BLOCKER;
  float widest = penumbra_of_blocker(query.view, size_of(light), query.plane.z, blocker_before(query, region.nearest));
  Receiving here = receiving_at(at, int(push.light));
  vec2 sum = occluders_in(here, light, kernel_of(here, int(push.light), widest));
  float z_b = sum.y > 0.0 ? sum.x / sum.y : imageLoad(occluder, ivec3(at, push.light)).x;
  return z_b == NO_BLOCKER ? z_b : blocker_before(query, z_b);
}

#include "soft/listed_blocker.glsl"
