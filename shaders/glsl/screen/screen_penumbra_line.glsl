// Penumbrae on the screen in the published, separable form (MohammadBagher et al. 2010; Macedo 2018, eq. 4.4-4.5, ch. 5.4), one
// direction: as many pixels on either axis as the penumbra covers at the pixel's depth, whatever the receiver's tilt. Only the
// receiver's own surface counts.
#include "screen/screen_kernel.glsl"
#include "lib/soft_shadow.glsl"

layout(push_constant) uniform Push { int layer; float reach; } push;
layout(local_size_x = 8, local_size_y = 8) in;

#ifdef ALONG_Y_AXIS
const ivec2 ALONG = ivec2(0, 1);
float before(ivec2 pixel) { return imageLoad(rows, ivec3(pixel, push.layer)).x; }
void store(ivec2 pixel, float v) { imageStore(visibility, ivec3(pixel, push.layer), vec4(v)); }
#else
const ivec2 ALONG = ivec2(1, 0);
float before(ivec2 pixel) { return source_at(pixel, push.layer).x; }
void store(ivec2 pixel, float v) { imageStore(rows, ivec3(pixel, push.layer), vec4(v)); }
#endif

float weight_of(float place) {
#if KERNEL == KERNEL_GAUSSIAN
  return exp(-0.5 * CUT_OFF * CUT_OFF * place * place);
#else
  return 1.0;
#endif
}

// `half_width`: pixels.
float line_mean(ivec2 at, Receiving here, float half_width) {
  Light light = lights[light_of(push.layer)];
  int taps = clamp(int(2.0 * half_width) | 1, 1, params.line_taps | 1);
  vec2 sum = vec2(0.0);
  int i = 0;
  do {
    float place = (2.0 * float(i) + 1.0) / float(taps) - 1.0;
    ivec2 pixel = at + ALONG * int(round(place * half_width));
    vec3 position;
    if (shows_surface(here, light, pixel, position)) sum += weight_of(place) * vec2(before(pixel), 1.0);
  } while (++i < taps);
  return sum.y > 0.0 ? sum.x / sum.y : before(at);
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = textureSize(source, 0).xy;
  if (any(greaterThanEqual(at, size))) return;
  float penumbra = width_at(at, push.layer).x, v = before(at);
  Receiving here = receiving_at(at, push.layer);
  if (here.receives && penumbra > 0.0) {
    float half_tangent = 0.5 * frame.viewport.y * length(frame.ray_dy.xyz);
    v = line_mean(at, here, 0.5 * push.reach * screen_width(penumbra, frame.viewport.y, half_tangent, here.depth));
  }
  store(at, clamp(v, 0.0, 1.0));
}
