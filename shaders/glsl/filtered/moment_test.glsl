// Visibility of every camera pixel from a pre-filtered shadow map.
#include "map/shadow_query.glsl"
#include "lib/moment_warp.glsl"
#include "lib/variance_shadow.glsl"
#include "lib/moment_shadow.glsl"
#include "lib/convolution_shadow.glsl"
#ifdef HAS_WIDTH
#include "map/light_kernel.glsl"
#if TABLE_INTEGER == 1
#define SUMMED uvec4
#else
#define SUMMED vec4
#endif
SUMMED summed_at(ivec2 texel, int layer) { return moments_at(texel, layer); }
#include "lib/summed_area.glsl"

const float SQUARE_OF_DISC = 0.886226925;  // half a square's side, in radii of the disc of the same area
vec2 kernel_half;                          // of the pixel at hand, texels
#endif

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef HAS_WIDTH
// The rectangle in which the map sees the light through the penumbra's width; of a round light a square of the same area. A texel
// at least, the finest that the map can tell.
void find_kernel(ivec2 pixel, Query query) {
  Light light = lights[push.light];
  vec2 half_width = half_kernel(query.view, half_size_of(light), size_of(light), width_at(pixel, int(push.light)).x, query.plane.z);
  if (is_round(light)) half_width *= SQUARE_OF_DISC;
  kernel_half = clamp(half_width, vec2(0.5), vec2(0.5 * float(params.largest_kernel)));
}
float footprint_level(ivec2 pixel, Query query) { return 0.0; }
// The mean over the kernel, from a table with the steps of passes/filtered/summed_area.h.
vec4 filtered(Query query, int layer, float level) {
  vec4 sum = summed_rectangle(query.position - kernel_half, query.position + kernel_half, textureSize(moments, 0).xy, layer);
  vec4 mean = sum / (4.0 * kernel_half.x * kernel_half.y);
#if TABLE_INTEGER == 1
  mean = params.least + mean * ((params.greatest - params.least) / TABLE_STEPS);
#endif
  return mean;
}
#else
// Bilinear, in full precision (hardware filters weigh in 1/256) and within the view.
vec4 bilinear(vec2 position, int layer, int level) {
#ifdef MIP_MAPS
#define READ(p) texelFetch(moments, ivec3(clamp(p, ivec2(0), last), layer), level)
  ivec2 last = textureSize(moments, level).xy - 1;
#else
#define READ(p) moments_at(clamp(p, ivec2(0), last), layer)
  ivec2 last = textureSize(moments, 0).xy - 1;
#endif
  vec2 corner = position - 0.5, part = fract(corner);
  ivec2 p = ivec2(floor(corner));
  vec4 top = mix(READ(p), READ(p + ivec2(1, 0)), part.x);
  vec4 bottom = mix(READ(p + ivec2(0, 1)), READ(p + ivec2(1, 1)), part.x);
  return mix(top, bottom, part.y);
}

#ifdef MIP_MAPS
// Texels of the map that the pixel's step to its neighbour covers on the receiver's tangent plane, as a level.
float footprint_level(ivec2 pixel, Query query) {
  float device_depth = depth_at(pixel).x;
  vec3 n = octahedral_decode(geometric_at(pixel).xy), p = relative_position(pixel, device_depth);
  LightView view = query.view;
  float size = map_size(), most = 1.0, least_facing = 1e-2 * length(p);
  for (int axis = 0; axis < 2; ++axis) {
    vec3 ray = p + image_depth(device_depth) * (axis == 0 ? frame.ray_dx.xyz : frame.ray_dy.xyz);
#ifdef ORTHOGRAPHIC_CAMERA
    float facing = dot(n, view_axis());
    vec3 neighbour = ray + (abs(facing) > 1e-4 ? dot(n, p - ray) / facing : 0.0) * view_axis();
#else
    float along = dot(n, p), facing = dot(n, ray);
    vec3 neighbour = ray * (abs(facing) > least_facing * 1e-2 ? along / facing : 1.0);
#endif
    vec3 projected = light_project(view, light_space(view, vec4(neighbour, 1.0)));
    float moved = distance(projected.xy * size, query.position);
    if (projected.z > 0.0) most = max(most, min(moved, size));
  }
  return log2(most);
}

vec4 filtered(Query query, int layer, float level) {
  int levels = textureQueryLevels(moments);
  int low = min(int(level), levels - 1), high = min(low + 1, levels - 1);
  vec2 at = query.position / map_size();
  vec4 a = bilinear(at * vec2(textureSize(moments, low).xy), layer, low);
  vec4 b = bilinear(at * vec2(textureSize(moments, high).xy), layer, high);
  return mix(a, b, fract(level));
}
#else
float footprint_level(ivec2 pixel, Query query) { return 0.0; }
vec4 filtered(Query query, int layer, float level) { return bilinear(query.position, layer, 0); }
#endif
#endif

// The receiver's depth at its own place, linear in [0, 1]. A kernel on a slope also holds nearer parts of the receiver itself,
// which moments cannot tell from occluders: `bias_kernel` moves the receiver towards the light by that part of what the plane
// rises over half the kernel.
float receiver_linear_depth(Query query, float level) {
  LightView view = query.view;
  Receiver plane = query.plane;
#ifdef HAS_WIDTH
  float half_width = max(kernel_half.x, kernel_half.y) - 0.5;
#else
  float half_width = 0.5 * (float(params.kernel) * exp2(level) - 1.0);
#endif
  float z = receiver_depth(view, plane, plane.texel, true);
  vec2 outwards = half_width * sign(plane.gradient);
  float farthest = receiver_depth(view, plane, plane.texel + outwards, true);
  return clamp(z - params.bias_kernel * max(farthest - z, 0.0), 0.0, 1.0);
}

float warped_visibility(vec2 stored, float t, float exponent) {
  float scale = warp_scale(stored.x, t);
  vec2 scaled = scale_moments(stored, scale);
  float least = max(warped_variance(params.minimum_variance, t * scale, exponent), 1e-12);
#if BOUND == BOUND_CHEBYSHEV
  return chebyshev_visibility(scaled, t * scale, least);
#else
  return gaussian_visibility(scaled, t * scale, least, BOUND == BOUND_GAUSSIAN);
#endif
}

float reconstruct(Query query, float z, float level) {
  int layer = query.layer * MOMENT_LAYERS;
#if BASIS == BASIS_FOURIER
  vec2 even = csm_first(z), rotation = csm_rotation(z);
  float sum = 0.0;
  for (int i = 0; i < MOMENT_LAYERS; ++i) {
    vec4 b = filtered(query, layer + i, level);
    vec2 odd = csm_next(even, rotation);
    sum += csm_term(b.xy, even, 2 * i, params.terms, params.ringing);
    if (2 * i + 1 < params.terms) sum += csm_term(b.zw, odd, 2 * i + 1, params.terms, params.ringing);
    even = csm_next(odd, rotation);
  }
  return csm_visibility(sum);
#else
  vec4 b = filtered(query, layer, level);
#if BASIS == BASIS_VARIANCE
#if BOUND == BOUND_CHEBYSHEV
  return chebyshev_visibility(b.xy, z - 0.5, params.minimum_variance);
#else
  return gaussian_visibility(b.xy, z - 0.5, params.minimum_variance, BOUND == BOUND_GAUSSIAN);
#endif
#elif BASIS == BASIS_EXPONENTIAL
  // Annen et al. 2008, eq. 4-5; log space: the filtered depth is that of the mean exponential.
  return SPACE == SPACE_LOG ? min(exp(params.exponent * min(b.x - z, 0.0)), 1.0) : min(exp(-params.exponent * z) * b.x, 1.0);
#elif BASIS == BASIS_EXPONENTIAL_VARIANCE
  return warped_visibility(b.xy, positive_warp(z, params.exponent), params.exponent);
#elif BASIS == BASIS_EXPONENTIAL_VARIANCE_4
  // Both warps bound the same share: the smaller bound holds.
  return min(warped_visibility(b.xy, positive_warp(z, params.exponent), params.exponent),
             warped_visibility(b.zw, negative_warp(z, params.negative_exponent), params.negative_exponent));
#else
  vec4 m = PRECISION == PRECISION_HALF ? inverse_quantisation_transform(b) : b;
  float bias = params.moment_bias * (PRECISION == PRECISION_HALF ? HALF_MOMENT_BIAS : SINGLE_MOMENT_BIAS);
#if SOLVER == SOLVER_HAMBURGER
  return 1.0 - hamburger_occlusion(bias_moments(m, HAMBURGER_CENTRE, bias), signed_depth(z));
#else
  return 1.0 - hausdorff_occlusion(bias_moments(m, HAUSDORFF_CENTRE, bias), signed_depth(z));
#endif
#endif
#endif
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(visibility).xy))) return;
  Query query;
  int state = make_query(at, query);
#ifdef HAS_WIDTH
  find_kernel(at, query);
#endif
  float level = footprint_level(at, query);
  float v = reduce_light_leak(reconstruct(query, receiver_linear_depth(query, level), level), params.light_leak_reduction);
  imageStore(visibility, ivec3(at, push.light), vec4(state == PIXEL_INSIDE ? v : unmapped_visibility(state)));
}
