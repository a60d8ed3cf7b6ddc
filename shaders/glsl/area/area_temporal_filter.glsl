// Temporal coherence, third part: where the tests of a pixel do not settle its shadow, those of its neighbours in the shadow buffer
// help (section 5.2.3), blended in by the standard error (5.14).
#include "area/area_temporal_query.glsl"
#include "lib/vogel_disc.glsl"

layout(local_size_x = 64) in;

const int FIRST_LOOK = 4;  // outermost neighbours: where they and the pixel are all lit or all in shadow, so are the others

struct Neighbourhood {
  ivec2 centre;
  float depth;      // view depth
  vec2 gradient;    // of the reciprocal depth, of itself, per pixel
  vec2 radius;      // pixels
  vec2 direction;   // of the next neighbour
  float sum, count;
};

// Adds neighbours `first` down to, but not, `end`: Vogel's points from the rim inwards (5.11)-(5.12).
void gather_neighbours(inout Neighbourhood around, int first, int end) {
  const float c = cos(GOLDEN_ANGLE), s = sin(GOLDEN_ANGLE);
  ivec2 last = imageSize(visibility).xy - 1;
  for (int i = first; i > end; --i) {
    float radius = sqrt((float(i) + 0.5) / float(params.neighbours));
    ivec2 at = clamp(ivec2(round(vec2(around.centre) + radius * around.direction * around.radius)), ivec2(0), last);
    around.direction = mat2(c, s, -s, c) * around.direction;
    ShadowHistory h = unpack_history(imageLoad(shadow_buffer, ivec3(at, push.light)));
    float expected = around.depth / max(1.0 + dot(around.gradient, vec2(at - around.centre)), 1e-3);
    bool same = h.tests > 0.0 && same_depth(expected, h.depth, params.neighbour_tolerance);
    around.sum += same ? hidden_share(h) : 0.0;
    around.count += float(same);
  }
}

// Mean share of hidden light around the pixel, itself included. Its filter has the width of the penumbra (5.9)-(5.10).
float filtered_share(ivec2 at, ShadowHistory h, int count) {
  float device_depth = depth_at(at).x;
  vec3 p = relative_position(at, device_depth), n = octahedral_decode(geometric_at(at).xy);
  LightView view = area_view(push.view);
  float z = -light_space(view, vec4(p, 1.0)).z, depth = view_depth(device_depth);
  // The n tests that a pixel has had are edges of its shadow already, spread over the penumbra's width: the filter only has to reach
  // from one to the next.
  float width = params.spread * penumbra_width(z, h.blocker, uintBitsToFloat(push.part.x)) * inversesqrt(max(h.tests, 1.0));
  float angle = 6.2831853 * interleaved_gradient_noise(at);
  vec2 pixel = image_depth(device_depth) * vec2(length(frame.ray_dx.xyz), length(frame.ray_dy.xyz));
  float share = hidden_share(h);
  Neighbourhood around = Neighbourhood(at, depth, depth_gradient(p, n, depth), min(width / pixel, vec2(params.max_radius)),
                                       vec2(cos(angle), sin(angle)), share, 1.0);
  bool wide = width > 0.5 * pixel.y;  // reaches another pixel
  count = wide ? count : 0;
  int looked = min(count, FIRST_LOOK);
  gather_neighbours(around, count - 1, count - 1 - looked);
  bool plain = (share == 0.0 && around.sum == 0.0) || (share == 1.0 && around.sum == around.count);
  gather_neighbours(around, count - 1 - looked, plain ? count - 1 - looked : -1);
  return around.sum / around.count;
}

void main() {
  ivec2 at;
  bool listed = listed_pixel(list_slot(), imageSize(visibility).x, at);
  ivec3 place = ivec3(at, push.light);
  ShadowHistory h = unpack_history(imageLoad(shadow_buffer, place));
  float filtered = filtered_share(at, h, listed && h.blocker > BLOCKER_NONE ? params.neighbours : 0);
  float weight = tests_weight(h, params.s_min, params.s_max, params.least_tests);
  float hidden = mix(filtered, hidden_share(h), weight);
  if (listed && h.blocker > BLOCKER_NONE) imageStore(visibility, place, vec4(1.0 - hidden));
}
