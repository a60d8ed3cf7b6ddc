// Geometry that all soft shadows share: from blocker to penumbra, from penumbra to kernel. Pure functions.
//
// The light's frame has its apex at the light's centre and axes along the light's own; the map's plane is parallel to the
// light's. z: linear depth along the axis, world units (device depth makes penumbrae wrong by orders of magnitude). p: the
// receiver, b: the blocker. Kernels are full widths. A directional light's size is that of (G5) and its map orthographic.
#ifndef GNOMON_SOFT_SHADOW
#define GNOMON_SOFT_SHADOW

// Value of a `blocker` image where nothing hides any part of the light; linear depths are greater than 0.
const float NO_BLOCKER = 0.0;

// Width of the penumbra in the plane through the receiver parallel to the light (Macedo 2018, eq. 5.2), world units.
// `size`: width of the light, world units.
float penumbra_width(float size, float z_p, float z_b) { return size * (z_p - z_b) / z_b; }

// The same of a directional light (G5). `size`: directional_size().
float directional_penumbra_width(float size, float z_p, float z_b) { return size * (z_p - z_b); }
// `tangent`: of half the light's angular diameter.
float directional_size(float tangent) { return 2.0 * tangent; }

// Width on the plane at depth `plane`, usually the map's near plane, of the blockers at z_b that hide some of the light from
// the receiver: w_p n / z_p.
float kernel_width(float size, float plane, float z_p, float z_b) { return size * plane * (z_p - z_b) / (z_b * z_p); }
// The same of a penumbra whose width is known.
float kernel_of_penumbra(float penumbra, float plane, float z_p) { return penumbra * plane / z_p; }
// The same from perspective depths (Rzeczkowski 2024, eq. 3.6): it is linear in them, so that the mean of depths is the mean of
// kernels.
float kernel_width_of_device_depth(float size, float near, float far, float d_p, float d_b) {
  return size * (far - near) / far * (d_p - d_b);
}
// Texels of a width on the plane, in a map of `side` texels whose field of view has the tangent `half_tangent` to each side.
float kernel_texels(float kernel, float plane, float half_tangent, float side) {
  return kernel * side / (2.0 * plane * half_tangent);
}
// Texels of a penumbra in an orthographic map that is `map_width` world units wide.
float directional_kernel_texels(float penumbra, float map_width, float side) { return penumbra * side / map_width; }

// Width on the near plane of the region that holds every possible blocker: the kernel of the nearest one there may be, on the
// near plane itself. The search shrinks it: the kernel of the nearest depth in the region, until it no longer changes.
float first_search_width(float size, float near, float z_p) { return size * (z_p - near) / z_p; }

// Where on the plane, from the receiver's own place there, the ray to the point `u` of the light passes it when it is at depth
// z_b: the kernel is a scaled copy of the light and not mirrored.
vec2 kernel_point(vec2 u, float plane, float z_p, float z_b) { return u * (plane * (z_p - z_b) / (z_b * z_p)); }

// The point of the light's plane that Q = (q, z_s) hides from P = (p, z_p) (Macedo 2018, ch. 2.5.2).
vec2 back_project(vec2 q, float z_s, vec2 p, float z_p) { return (q * z_p - p * z_s) / (z_p - z_s); }

// The silhouette's site (s, z_s) along the ray through the light's centre, at the receiver's depth.
vec2 slide_site(vec2 s, float z_s, float z_p) { return s * (z_p / z_s); }
// Visibility beside a straight silhouette. `way`: the receiver's distance to the slid site; `penumbra`: its width there. Exact for
// any tilt of the receiver (Macedo 2018, eq. 5.3, with beta = 1).
float half_plane_visibility(float way, float penumbra, bool lit) {
  float part = penumbra > 0.0 ? min(way / penumbra, 0.5) : 0.5;
  return lit ? 0.5 + part : 0.5 - part;
}

// Where the point (q, z_q) of the receiver's tangent plane is seen from the light's centre, at the receiver's depth and from the
// receiver itself: what the screen-space kernel measures.
vec2 parallel_offset(vec2 q, float z_q, vec2 p, float z_p) { return q * (z_p / z_q) - p; }

struct ScreenKernel {
  vec2 major, minor;  // half axes, pixels
};
// All pixels d with |J d| <= w_p / 2. `along_x`, `along_y`: columns of J, the derivative of parallel_offset() by the pixel.
ScreenKernel screen_kernel(vec2 along_x, vec2 along_y, float penumbra) {
  // Right singular vectors of J: eigenvectors of its transpose times itself.
  float a = dot(along_x, along_x), b = dot(along_x, along_y), c = dot(along_y, along_y);
  float mean = 0.5 * (a + c), spread = length(vec2(0.5 * (a - c), b));
  float large = mean + spread, determinant = along_x.x * along_y.y - along_x.y * along_y.x;
  float small = determinant * determinant / max(large, 1e-30);  // mean - spread, without its cancellation
  vec2 turned = a >= c ? vec2(0.5 * (a - c) + spread, b) : vec2(b, 0.5 * (c - a) + spread);
  vec2 steep = dot(turned, turned) > 0.0 ? normalize(turned) : vec2(1.0, 0.0);
  float half_width = 0.5 * penumbra;
  return ScreenKernel(half_width * inversesqrt(max(small, 1e-30)) * vec2(-steep.y, steep.x),
                      half_width * inversesqrt(max(large, 1e-30)) * steep);
}
// Its isotropic form (Macedo 2018, eq. 4.4-4.5), pixels on both axes. `height`: of the image, pixels; `half_tangent`: of its
// vertical field of view; `z_eye`: view depth.
float screen_width(float penumbra, float height, float half_tangent, float z_eye) {
  return height * penumbra / (2.0 * half_tangent * z_eye);
}

// A texel blocks when it is nearer than the receiver's plane there; equal depth is lit, as in (3.2).
bool blocks(float texel_depth, float plane_depth) { return texel_depth < plane_depth; }
// Where all of a region blocks, the receiver is in umbra only if the kernel lies inside of the region.
bool holds_kernel(vec2 region, vec2 kernel) { return all(lessThanEqual(kernel, region)); }

#endif
