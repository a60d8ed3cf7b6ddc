// What of a light the texels of a map hide from the receiver of a query (Macedo 2018, ch. 2.5.2), in the cells of
// lib/light_mask.glsl. After map/light_kernel.glsl.
//
// In post-projective depth F (lib/receiver_plane.glsl) the place on the light that a point of the map hides is affine in its
// distance from the receiver's own place and falls with 1 / (F_p - F_s), for every projection: (q z_p - p z_s) / (z_p - z_s) =
// (q / z_s - p / z_p) / (1 / z_s - 1 / z_p).
#include "lib/light_mask.glsl"

const float UNDECIDED = 2.0;  // visibility of pixels that are listed, until they are worked on

struct BackProjection {
  float depth;  // of the receiver itself, without bias: post-projective depth - 1
  vec2 scale;   // cells per texel, times post-projective depth
};

// World size of a texel times the rate of depth there, for each axis: of two texels, one beside the other on a surface at 45 degrees,
// the difference of depth, at distance 1 (orthographic: anywhere).
vec2 depth_of_texel(LightView view) { return 2.0 * view.range.zw / map_size() * depth_rate(view, 1.0); }

// Of the larger axis, at the receiver.
float depth_of_texel_at(Query query) {
  vec2 unit = depth_of_texel(query.view);
  return max(unit.x, unit.y) / (is_orthographic(query.view) ? 1.0 : query.plane.z);
}

BackProjection back_projection(Query query, Light light) {
  vec2 half_cells = vec2(0.5 * float(MASK_SIDE)) / half_size_of(light);
  return BackProjection(far_depth(query.view, query.plane.z), depth_of_texel(query.view) * half_cells);
}

// Post-projective depth - 1 of what the map holds.
float surface_depth(LightView view, float encoded) {
  if (ENCODING == ENCODING_LINEAR && !is_orthographic(view)) return far_depth(view, decode_linear(view, encoded));
  return encoded - 1.0;
}

// Of the receiver itself, without bias, as the map encodes depth.
float receiver_own_depth(Query query, BackProjection b) {
  if (ENCODING == ENCODING_LINEAR && !is_orthographic(query.view)) return encode_linear(query.view, query.plane.z);
  return 1.0 + b.depth;
}

// How a texel's place on the light grows with its distance from the receiver's, for what is by `before` nearer than the receiver. 0:
// it is not, and hides nothing.
float magnification(float before) { return before > 0.0 ? 1.0 / max(before, 1e-30) : 0.0; }

// Are two neighbours parts of one surface, which hides what is between them, too? `gap`: difference of their depths up to which they
// are, texel widths there; `a`, `b`: their magnifications.
bool is_one_surface(BackProjection p, Query query, float a, float b, float gap) {
  float unit = max(depth_of_texel(query.view).x, depth_of_texel(query.view).y), before = 1.0 / min(a, b);
  // 1 / z is affine in F.
  float per_distance = is_orthographic(query.view) ? 1.0 : 1.0 / query.plane.z + max(1.0 / a, before) / depth_rate(query.view, 1.0);
  return abs(1.0 / a - 1.0 / b) <= gap * unit * per_distance;
}
