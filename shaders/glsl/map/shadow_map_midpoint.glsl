// Midpoint shadow map (Woo 1992): halfway between the first and the second surface seen from the light.
#include "frame/frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(depth).xy;
  if (any(greaterThanEqual(at.xy, size))) return;
  float a = first_at(at.xy, at.z).x, b = second_at(at.xy, at.z).x;
  // Nothing behind: the background counts as infinitely far, and half of that is no surface; the first one stands.
  LightView view = views[at.z];
  float middle = a;
  if (b < 1.0) {
#if ENCODING == ENCODING_LINEAR
    middle = 0.5 * (a + b);
#else
    middle = is_orthographic(view)
                 ? 0.5 * (a + b)
                 : encode_perspective(view, 2.0 / (decode_perspective(view, a) + decode_perspective(view, b)));
#endif
  }
  imageStore(depth, at, vec4(middle));
}
