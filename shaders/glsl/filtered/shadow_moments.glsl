// A shadow map's depth to the basis of a technique, texel by texel.
#include "frame/frame.glsl"
#include "lib/moment_warp.glsl"
#include "lib/convolution_shadow.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Texels that hold nothing are at the far end.
float linear_depth(LightView view, float d) {
#if ENCODING == ENCODING_LINEAR
  return d;
#else
  if (is_orthographic(view) || d >= 1.0) return d;
  return clamp(encode_linear(view, decode_perspective(view, d)), 0.0, 1.0);
#endif
}

#if BASIS != BASIS_FOURIER && BASIS != BASIS_FOURIER_DEPTH
vec4 basis_of(float z) {
#if BASIS == BASIS_VARIANCE
  return vec4(variance_moments(z), 0.0, 0.0);
#elif BASIS == BASIS_EXPONENTIAL
  return vec4(SPACE == SPACE_LOG ? z : exp(params.exponent * z));
#elif BASIS == BASIS_EXPONENTIAL_DEPTH
  float far = exp(params.exponent * (z - 1.0));
  return vec4(far, far * z, z, 0.0);
#elif BASIS == BASIS_EXPONENTIAL_VARIANCE
  return vec4(first_two_moments(positive_warp(z, params.exponent)), 0.0, 0.0);
#elif BASIS == BASIS_EXPONENTIAL_VARIANCE_4
  return vec4(first_two_moments(positive_warp(z, params.exponent)),
              first_two_moments(negative_warp(z, params.negative_exponent)));
#else
  return PRECISION == PRECISION_HALF ? quantisation_transform(four_moments(z)) : four_moments(z);
#endif
}
#endif

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at.xy, imageSize(moments).xy))) return;
  float z = linear_depth(views[at.z], shadow_map_at(at.xy, at.z).x);
#if BASIS == BASIS_FOURIER || BASIS == BASIS_FOURIER_DEPTH
  const int LAYERS = BASIS == BASIS_FOURIER ? MOMENT_LAYERS : MOMENT_LAYERS / 2;
  vec2 even = csm_first(z), rotation = csm_rotation(z);
  for (int i = 0; i < LAYERS; ++i) {
    vec2 odd = csm_next(even, rotation);
    imageStore(moments, ivec3(at.xy, at.z * MOMENT_LAYERS + i), vec4(even, odd));
#if BASIS == BASIS_FOURIER_DEPTH
    imageStore(moments, ivec3(at.xy, at.z * MOMENT_LAYERS + LAYERS + i), z * vec4(even, odd));
#endif
    even = csm_next(odd, rotation);
  }
#elif BASIS == BASIS_EXPONENTIAL_DEPTH
  vec4 basis = basis_of(z);
  imageStore(moments, ivec3(at.xy, at.z * MOMENT_LAYERS), vec4(basis.xy, 0.0, 0.0));
  imageStore(moments, ivec3(at.xy, at.z * MOMENT_LAYERS + 1), vec4(basis.z, 0.0, 0.0, 0.0));
#else
  imageStore(moments, at, basis_of(z));
#endif
}
