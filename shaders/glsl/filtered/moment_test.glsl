// Visibility of every camera pixel from a pre-filtered shadow map; with a width for each, of the listed ones.
#include "map/shadow_query.glsl"
#include "filtered/stored_moments.glsl"
#ifdef HAS_WIDTH
#include "map/light_kernel.glsl"
#include "filtered/table_mean.glsl"
#include "frame/pixel_list.glsl"
#include "lib/moment_occluders.glsl"

const float SQUARE_OF_DISC = 0.886226925;  // half a square's side, in radii of the disc of the same area
vec2 kernel_half, kernel_middle;           // of the pixel's part at hand, texels
#endif

#ifdef HAS_WIDTH
// The rectangle in which the map sees the light through the penumbra's width; of a round light a square of the same area. A texel
// at least, the finest that the map can tell.
void find_kernel(ivec2 pixel, Query query) {
  Light light = lights[push.light];
  vec2 half_width = half_kernel(query.view, half_size_of(light), size_of(light), width_at(pixel, int(push.light)).x, query.plane.z);
  if (is_round(light)) half_width *= SQUARE_OF_DISC;
  kernel_half = clamp(half_width, vec2(0.5 * params.narrowest), vec2(0.5 * float(params.largest_kernel)));
  kernel_middle = query.position;
}
float footprint_level(ivec2 pixel, Query query) { return 0.0; }
vec4 filtered(Query query, int layer, float level) {
  return table_mean(kernel_middle - kernel_half, kernel_middle + kernel_half, layer);
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
  vec2 outwards = half_width * sign(plane.gradient);
#ifdef HAS_WIDTH
  vec2 middle = plane.texel + (kernel_middle - query.position);
#else
  vec2 middle = plane.texel;
#endif
  float z = receiver_depth(view, plane, middle, true);
  float farthest = receiver_depth(view, plane, middle + outwards, true);
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
#if BASIS == BASIS_FOURIER || BASIS == BASIS_FOURIER_DEPTH
  vec2 even = csm_first(z), rotation = csm_rotation(z);
  float sum = 0.0;
  for (int i = 0; i < SERIES_LAYERS; ++i) {
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
#elif BASIS == BASIS_EXPONENTIAL_DEPTH
#ifdef HAS_WIDTH
  // Over the mean of the plane's own exponential, which on slopes is more than that of its middle.
  vec2 rise = params.exponent * linear_rise(query, kernel_half);
  float plane = exp(params.exponent * (z - 1.0)) * mean_of_exponential(rise.x) * mean_of_exponential(rise.y);
#else
  float plane = exp(params.exponent * (z - 1.0));
#endif
  return min(b.x / plane, 1.0);
#elif SOLVER == SOLVER_HAMBURGER
  return 1.0 - hamburger_occlusion(biased_moments(b, HAMBURGER_CENTRE), signed_depth(z));
#else
  return 1.0 - hausdorff_occlusion(biased_moments(b, HAUSDORFF_CENTRE), signed_depth(z));
#endif
#endif
}

float visibility_of(Query query, float level) {
  return reduce_light_leak(reconstruct(query, receiver_linear_depth(query, level), level), params.light_leak_reduction);
}

#ifdef HAS_WIDTH
layout(local_size_x = 64) in;

// The mean over parts of the kernel, each against the receiver's plane at its middle.
float mean_of_parts(Query query) {
  kernel_half /= float(params.parts);
  vec2 first = query.position - float(params.parts - 1) * kernel_half;
  float sum = 0.0;
  int y = 0;
  do {
    int x = 0;
    do {
      kernel_middle = first + 2.0 * vec2(x, y) * kernel_half;
      sum += visibility_of(query, 0.0);
    } while (++x < params.parts);
  } while (++y < params.parts);
  return sum / float(params.parts * params.parts);
}

void main() {
  ivec2 at;
  if (!listed_pixel(list_slot(), imageSize(visibility).x, at)) return;
  Query query;
  make_query(at, query);
  find_kernel(at, query);
  Light light = lights[push.light];
  float most_lit = share_above(horizon_at(at, query.view, half_size_of(light)), is_round(light));
  imageStore(visibility, ivec3(at, push.light), vec4(most_lit * mean_of_parts(query)));
}

#else

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(visibility).xy))) return;
  Query query;
  int state = make_query(at, query);
  float v = visibility_of(query, footprint_level(at, query));
  imageStore(visibility, ivec3(at, push.light), vec4(state == PIXEL_INSIDE ? v : unmapped_visibility(state)));
}

#endif
