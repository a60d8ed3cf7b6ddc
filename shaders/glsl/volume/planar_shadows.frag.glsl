// Darkens the pixels of the receiver: the camera's surface there lies on the plane. Nothing is tested against depth, so
// nothing fights with it.
#include "volume/planar_shadows.glsl"
#include "lib/octahedral.glsl"

#ifdef MASKED
layout(set = 2, binding = 0) uniform sampler2D base_color_texture;
layout(location = 0) in vec2 in_uv;
layout(location = 1) in float in_alpha;
#endif
layout(location = 0) out float out_visibility;

const float LEAST_COSINE = 0.9999;  // between normals: octahedral 16-bit ones are exact to 1e-8
#ifndef COARSER
#define COARSER 1  // a device's steps within a pixel, in 1/256 of it
#endif
const float DEPTH_PART = 1e-5 * COARSER;  // rounding of interpolated depth, as a part of it: a hundredth of a pixel
const float DEPTH_STEP = 2.4e-7;    // rounding of a device depth near 1, which standard z has at all distances

bool on_plane(ivec2 at, float device_depth) {
  float z = view_depth(device_depth);
  float tolerance = push.tolerance + DEPTH_PART * z;
#ifdef ORTHOGRAPHIC_CAMERA
  tolerance += DEPTH_STEP * (frame.depth.w - frame.depth.x);
#else
  if (frame.depth.y == 0.0) tolerance += DEPTH_STEP * z * z / frame.depth.x;
#endif
  vec3 n = octahedral_decode(geometric_at(at).xy);
  return abs(dot(n, push.plane.xyz)) >= LEAST_COSINE &&
         abs(dot(push.plane, vec4(relative_position(at, device_depth), 1.0))) <= tolerance;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float device_depth = depth_at(at).x;
  if (is_background(device_depth) || !on_plane(at, device_depth)) discard;
#ifdef MASKED
  Material material = materials[push.material];
  if (material.base_color.a * in_alpha * texture(base_color_texture, in_uv).a < material.alpha.x) discard;
#endif
  out_visibility = 0.0;
}
