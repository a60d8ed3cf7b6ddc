// For the listed pixels, which the image alone makes sites: what the camera's depth says of them.
#include "map/views.glsl"
#include "lib/distance_transform.glsl"
#include "lib/octahedral.glsl"
#include "lib/same_surface.glsl"
#include "lib/tiles.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push { int layer; float reach; } push;  // reach: world units

#if DEPTH_AWARE

// Does the light's shadow map decide about `p` with normal `n`? What faces away is in shadow by itself, and what the map does not hold
// is in none: no silhouette runs along there.
bool is_mapped(Light light, LightView view, vec3 p, vec3 n) { return faces_light(light, p, n) && in_map(light, view, p); }

// The four pixels around a corner, in the order of textureGather: does one differ from `value`, lie on the surface through `p` and
// belong to the map? `light`, `view`: of the layer.
bool differs(ivec2 corner, float value, vec3 p, vec3 n, float z, Light light, LightView view) {
  const ivec2 OFFSET[4] = ivec2[4](ivec2(-1, 0), ivec2(0, 0), ivec2(0, -1), ivec2(-1, -1));
  vec2 at = vec2(corner) / vec2(textureSize(depth, 0));
  vec4 values = textureGather(source, vec3(at, push.layer)), depths = textureGather(depth, at);
  vec4 normals_x = textureGather(geometric, at, 0), normals_y = textureGather(geometric, at, 1);
  ivec2 last = textureSize(depth, 0) - 1;
  bool one = false;
  for (int i = 0; i < 4; ++i) {
    // Beyond the image its edge is repeated.
    vec3 q = relative_position(clamp(corner + OFFSET[i], ivec2(0), last), depths[i]);
    bool receives = !is_background(depths[i]) && is_mapped(light, view, q, octahedral_decode(vec2(normals_x[i], normals_y[i])));
    one = one || (values[i] != value && receives && same_surface(p, n, q, z, params.depth_tolerance));
  }
  return one;
}

// Pixels of the 3x3 window count when they and the pixel itself lie on one surface.
bool is_site(ivec2 pixel, float device_depth) {
  vec3 p = relative_position(pixel, device_depth), n = octahedral_decode(geometric_at(pixel).xy);
  float z = image_depth(device_depth), value = source_at(pixel, push.layer).x;
  Light light = lights[light_of(push.layer)];
  LightView view = widest_view(light_of(push.layer));
  bool found_any = differs(pixel, value, p, n, z, light, view) || differs(pixel + ivec2(1, 0), value, p, n, z, light, view) ||
             differs(pixel + ivec2(0, 1), value, p, n, z, light, view) || differs(pixel + 1, value, p, n, z, light, view);
  return found_any && !is_background(device_depth) && is_mapped(light, view, p, n);
}

#endif

// Pixels between the site and any point at most `reach` from it, rounded up. A displacement d of the site's point, at view depth
// z and position t on the plane z = 1, moves its image by |d.xy - t d.z| / (z + d.z), which is at most reach |(t, 1)| / (z - reach).
int pixels_of_reach(ivec2 pixel, float device_depth) {
  ivec2 size = textureSize(depth, 0);
  int most = size.x + size.y;
  float z = view_depth(device_depth), room = z - push.reach;
  float pixel_size = min(length(frame.ray_dx.xyz), length(frame.ray_dy.xyz));  // at view depth 1
#ifdef ORTHOGRAPHIC_CAMERA
  float pixels = push.reach / (image_depth(device_depth) * pixel_size);
  return pixels < float(most) ? int(ceil(pixels)) : most;
#else
  float pixels = push.reach * length(relative_position(pixel, device_depth)) / (z * room * pixel_size);
  return room > 0.0 && pixels < float(most) ? int(ceil(pixels)) : most;
#endif
}

void main() {
  uint slot = tile_index(gl_WorkGroupID, gl_NumWorkGroups) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (slot >= found_arguments[3]) return;
  ivec2 pixel;
  unpack_site(found[slot], pixel);
  float device_depth = depth_at(pixel).x;
#if DEPTH_AWARE
  if (!is_site(pixel, device_depth)) return;
#endif
  imageAtomicOr(words, ivec3(pixel.x, pixel.y / WORD, push.layer), 1u << (pixel.y % WORD));
#if REACHING
  if (!is_background(device_depth)) atomicMax(reached[0], uint(pixels_of_reach(pixel, device_depth)));
#endif
}
