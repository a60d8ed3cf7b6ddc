// Revectorization-based shadow mapping (RBSM): anti-aliased hard shadows from an ordinary shadow map.
// Macedo, Efficient Shadow Anti-Aliasing Techniques Using Silhouette Revectorization, 2018, ch. 3 and 4.1.1.
// Pure functions over a shadow test. To use them in your own engine:
//
//   bool rbsm_lit(ivec2 texel, inout float lowering) { ... }  // your shadow test (3.2) of the shaded point against `texel`
//   #include "revectorization.glsl"
//   ...
//   ivec2 texel = ivec2(floor(p.xy * size));                  // p: point in the map, [0, 1]
//   vec2 c = fract(p.xy * size);                              // (3.1)
//   bool lit = rbsm_lit(texel, 0);
//   bvec4 d = rbsm_discontinuity(texel, lit);                 // (3.3)
//   if (any(d)) {                                             // otherwise the test's own answer stands
//     vec2 r = rbsm_relative_position_conservative or ...(rbsm_distances(texel, c, lit, d, max_size), lit, max_size);
//     visibility = rbsm_nonconservative(lit, r);              // or rbsm_conservative, rbsm_filtered
//   }
//
// `lowering` is state that the test may keep along one walk (the remedy of section 3.1.3); ignore it when the test
// evaluates the receiver's tangent plane at each texel.
//
// Directions: x left (-1, 0), y right (+1, 0), z top (0, -1), w bottom (0, +1), as in (3.3).
// Readings, where text and listings disagree: a distance runs from the fragment to the border of the texel where the walk
// ended, so it is `whole texels + c` to the left and `whole texels + 1 - c` to the right (listing A.3; dropping one of its two "1 -" mirrors
// the line); it is positive when the walk ended at the other visibility; a walk goes on while texels share a discontinuity with the
// fragment; the length is clamped to max_size as in A.4.
#ifndef GNOMON_REVECTORIZATION
#define GNOMON_REVECTORIZATION

// (3.3): which of the four neighbours differ in visibility.
bvec4 rbsm_discontinuity(ivec2 texel, bool lit) {
  float lowering = 0.0;
  bvec4 d;
  d.x = rbsm_lit(texel + ivec2(-1, 0), lowering) != lit;
  d.y = rbsm_lit(texel + ivec2(+1, 0), lowering) != lit;
  d.z = rbsm_lit(texel + ivec2(0, -1), lowering) != lit;
  d.w = rbsm_lit(texel + ivec2(0, +1), lowering) != lit;
  return d;
}

// Section 3.1.3: signed distance, in texels, to the end of the silhouette along `direction`. `to_border`: from the
// fragment to its own texel's border. `side_a`, `side_b`: the fragment's discontinuities across the walk; along it none
// can be shared, for the texel behind has the fragment's visibility.
float rbsm_walk(ivec2 texel, ivec2 direction, float to_border, bool lit, bool side_a, bool side_b, int max_size) {
  ivec2 across = direction.yx;
  if (across.x + across.y < 0) across = -across;
  float lowering = 0.0;
  float whole = 0.0;
  bool found_end = false, going = true;
  int steps = 0;
  do {
    texel += direction;
    if (rbsm_lit(texel, lowering) != lit) {
      found_end = true;
      going = false;
    } else {
      bool shares = (side_a && rbsm_lit(texel - across, lowering) != lit) ||
                    (side_b && rbsm_lit(texel + across, lowering) != lit);
      going = shares;
      if (shares) whole += 1.0;
    }
  } while (going && ++steps < max_size);
  // On the texel's very border (c = 0) the sum may be zero, which has no sign, and (3.4) would see another shape.
  float distance = whole + max(to_border, 1e-6);
  return found_end ? distance : -distance;
}

// Distances to the left, right, top and bottom.
vec4 rbsm_distances(ivec2 texel, vec2 c, bool lit, bvec4 d, int max_size) {
  return vec4(rbsm_walk(texel, ivec2(-1, 0), c.x, lit, d.z, d.w, max_size),
              rbsm_walk(texel, ivec2(+1, 0), 1.0 - c.x, lit, d.z, d.w, max_size),
              rbsm_walk(texel, ivec2(0, -1), c.y, lit, d.x, d.y, max_size),
              rbsm_walk(texel, ivec2(0, +1), 1.0 - c.y, lit, d.x, d.y, max_size));
}

// (3.4): -2 for U (lit) or I (shadowed), 0 for I (lit) or U (shadowed), 1 for L.
float rbsm_shape(float d1, float d2) { return d1 > 0.0 && d2 > 0.0 ? -2.0 : d1 < 0.0 && d2 < 0.0 ? 0.0 : 1.0; }

float rbsm_length(float d1, float d2, int max_size) { return min(abs(d1) + abs(d2), float(max_size)); }

// One component of (3.5). `v`: V_SM.
float rbsm_relative_axis(float d1, float d2, float v, int max_size) {
  float t = rbsm_shape(d1, d2);
  return max(t, 2.0 * v - 1.0) * abs(max(t * d1, t * d2)) / rbsm_length(d1, d2, max_size);
}
// (3.5)
vec2 rbsm_relative_position(vec4 distances, bool lit, int max_size) {
  float v = lit ? 1.0 : 0.0;
  return vec2(rbsm_relative_axis(distances.x, distances.y, v, max_size),
              rbsm_relative_axis(distances.z, distances.w, v, max_size));
}

// One component of (4.1), as printed: positive for U too.
float rbsm_relative_axis_filtered(float d1, float d2, int max_size) {
  float t = rbsm_shape(d1, d2);
  return t * max(t * d1, t * d2) / rbsm_length(d1, d2, max_size);
}
// (4.1)
vec2 rbsm_relative_position_filtered(vec4 distances, int max_size) {
  return vec2(rbsm_relative_axis_filtered(distances.x, distances.y, max_size),
              rbsm_relative_axis_filtered(distances.z, distances.w, max_size));
}

// (3.6): the lit side only is revectorized; shadowed fragments stay.
float rbsm_conservative(bool lit, vec2 r) { return !lit || (r.x * r.y > 0.0 && 1.0 - r.x > r.y) ? 0.0 : 1.0; }

// (3.7) and (3.8), of which (3.9) is the union.
float rbsm_nonconservative(bool lit, vec2 r) {
  if (lit) return r.x * r.y > 0.0 && r.x + r.y < 0.5 ? 0.0 : 1.0;
  return r.x * r.y == 0.0 || abs(r.x) + abs(r.y) > 0.5 ? 0.0 : 1.0;
}

// (4.2)
float rbsm_filtered(bool lit, vec2 r) {
  float v = lit ? 1.0 : 0.0, turn = 2.0 * v - 1.0;
  if (r.x * r.y < 0.0) return clamp(1.0 - v + turn * max(r.x, r.y), 0.0, 1.0);
  if (r.x * r.y == 0.0) return v;
  return clamp(1.0 - v + turn * (r.x + r.y), 0.0, 1.0);
}

#endif
