// Percentage-closer filtering (Reeves, Salesin and Cook 1987): the mean of the shadow tests around the receiver. Every tap is
// tested against the receiver's plane there, so a wide kernel shows no moire on slopes.
#include "map/shadow_query.glsl"
#include "lib/min_max.glsl"
#include "lib/vogel_disc.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// `kernel` is odd, so the texels a box covers are one more in number than it is wide when it stands between texels, and can
// be read two by two. `border`: weights of the first and of the last texel of a row; the others weigh 1.
float box(Query query, ivec2 first, vec2 border_x, vec2 border_y) {
  float sum = 0.0;
  int y = 0;
  do {
    vec2 wy = vec2(y == 0 ? border_y.x : 1.0, y + 1 > params.kernel - 1 ? border_y.y : 1.0);
    int x = 0;
    do {
      vec2 wx = vec2(x == 0 ? border_x.x : 1.0, x + 1 > params.kernel - 1 ? border_x.y : 1.0);
      vec4 lit = lit_quad(query, first + ivec2(x, y));
      sum += wy.x * (wx.x * lit.w + wx.y * lit.z) + wy.y * (wx.x * lit.x + wx.y * lit.y);
    } while ((x += 2) <= params.kernel);
  } while ((y += 2) <= params.kernel);
  return sum / float(params.kernel * params.kernel);
}

float filtered(Query query, ivec2 pixel) {
#if SAMPLING == SAMPLING_BOX
  return box(query, ivec2(floor(query.position)) - params.kernel / 2, vec2(1.0, 0.0), vec2(1.0, 0.0));
#elif SAMPLING == SAMPLING_SMOOTH_BOX
  vec2 begin = query.position - 0.5 * float(params.kernel);
  vec2 part = fract(begin);  // of the first texel that the box leaves out, and of the last that it takes in
  return box(query, ivec2(floor(begin)), vec2(1.0 - part.x, part.x), vec2(1.0 - part.y, part.y));
#else
  const float TURN = 6.28318531;  // radians
  float rotation = ROTATE == 1 ? TURN * interleaved_gradient_noise(pixel) : 0.0;
  float sum = 0.0;
  int i = 0;
  do {
    vec2 at = query.position + 0.5 * float(params.kernel) * vogel_point(i, params.samples, rotation);
    ivec2 last = textureSize(shadow_map, 0).xy - 1;
    sum += is_lit(query, clamp(ivec2(floor(at)), ivec2(0), last)) ? 1.0 : 0.0;
  } while (++i < params.samples);
  return sum / float(params.samples);
#endif
}

#if USE_MIN_MAX == 1
// Of the window around the receiver, a texel wider than the filter to each side.
int plainly(Query query) {
  ivec2 size = textureSize(shadow_map, 0).xy, texel = clamp(ivec2(floor(query.position)), ivec2(0), size - 1);
  vec2 low = max(vec2(texel) - float(params.kernel / 2 + 1), vec2(0.0)) + 0.5;
  vec2 high = min(vec2(texel) + float(params.kernel / 2 + 1), vec2(size - 1)) + 0.5;
  vec4 corners = receiver_depths(query.view, query.plane, vec4(low.x, high.x, high.x, low.x),
                                 vec4(high.y, high.y, low.y, low.y), ENCODING == ENCODING_LINEAR);
  return min_max_compare(min_max_of(corners), imageLoad(around, ivec3(texel / MIN_MAX_BLOCK, query.layer)).xy);
}
#endif

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(visibility).xy))) return;
  Query query;
  int state = make_query(at, query);
  float v = unmapped_visibility(state);
#if USE_MIN_MAX == 1
  int plain = plainly(query);
  if (state == PIXEL_INSIDE) v = plain == MIXED ? clamp(filtered(query, at), 0.0, 1.0) : plain == PLAINLY_LIT ? 1.0 : 0.0;
#else
  float filtered_v = clamp(filtered(query, at), 0.0, 1.0);
  if (state == PIXEL_INSIDE) v = filtered_v;
#endif
  imageStore(visibility, ivec3(at, push.light), vec4(v));
}
