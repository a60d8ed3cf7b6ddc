// The kernel of a camera pixel's penumbra on the screen: places in the image that see the receiver's own surface through a scaled
// copy of the light. Uses the ports `depth` and `geometric`, the parameters `depth_tolerance` and `bend`.
#include "frame/light_size.glsl"
#include "frame/receiving.glsl"
#include "lib/light_parallel.glsl"
#include "lib/light_shape.glsl"
#include "lib/same_surface.glsl"
#include "lib/soft_shadow.glsl"

// Places in it are those of the square [-1, 1]^2 whose axes are x and -y of the light, those of its map.
struct SurfaceKernel {
  ParallelImage image;
  LightView view;
  vec3 receiver;    // in the view's frame
  vec2 half_size;   // world units
  bool round_light;
  Horizon horizon;  // of the light
};

// `penumbra`: full width at the receiver, parallel to the light's larger side, world units.
SurfaceKernel kernel_of(Receiving here, int layer, float penumbra) {
  int index = light_of(layer);
  Light light = lights[index];
  uvec2 range = views_of(index);
  LightView view = views[view_of(light, range.x, range.y, here.position)];
  bool directional = is_directional(light);
  vec3 centre = directional ? light.direction.xyz : light.position.xyz;
  SurfaceKernel kernel;
  kernel.view = view;
  kernel.receiver = light_space(view, vec4(here.position, 1.0));
  kernel.image = parallel_image(frame.clip_from_relative, frame.viewport.xy, here.position, here.normal, centre, directional,
                                view.rows[0].xyz, -view.rows[1].xyz);
  float size = size_of(light);
  kernel.horizon = receiver_horizon(view, here.position, here.normal, half_size_of(light));
  kernel.half_size = half_size_of(light) * (size > 0.0 ? penumbra / size : 0.0);
  kernel.round_light = is_round(light);
  return kernel;
}

// Least and greatest pixel of the kernel, cut off at the image. `reach`: of the kernel's half widths.
ivec4 kernel_bounds(SurfaceKernel kernel, float reach) {
  vec2 least = frame.viewport.xy, most = vec2(0.0);
  for (int i = 0; i < 4; ++i) {
    vec2 corner = vec2((i & 1) * 2 - 1, (i & 2) - 1), place;
    if (!parallel_place(kernel.image, reach * corner * kernel.half_size, place)) return ivec4(ivec2(0), ivec2(frame.viewport.xy) - 1);
    least = min(least, place);
    most = max(most, place);
  }
  vec2 last = frame.viewport.xy - 1.0;
  return ivec4(clamp(floor(least), vec2(0.0), last), clamp(floor(most), vec2(0.0), last));
}

// Taps a side that the kernel is worth: one a pixel, `most` at most.
int taps_over(ivec4 bounds, int most) {
  ivec2 pixels = bounds.zw - bounds.xy + 1;
  return clamp(max(pixels.x, pixels.y), 1, most);
}

// Does the image show the receiver's own surface at `pixel`, and does it face the light? What turns away is dark without any shadow.
// `position`: relative, of what it shows.
bool shows_surface(Receiving here, Light light, ivec2 pixel, out vec3 position) {
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(frame.viewport.xy)))) return false;
  float device_depth = depth_at(pixel).x;
  if (is_background(device_depth)) return false;
  vec3 normal = octahedral_decode(geometric_at(pixel).xy);
  position = relative_position(pixel, device_depth);
  return dot(normal, here.normal) > 0.0 && faces_light(light, position, normal) &&
         same_surface(here.position, here.normal, position, here.depth, params.depth_tolerance, params.bend);
}

// Where in the kernel's square a point of the surface really lies, which may bend away from the tangent plane.
vec2 kernel_place(SurfaceKernel kernel, vec3 position) {
  vec3 q = light_space(kernel.view, vec4(position, 1.0)), p = kernel.receiver;
  vec2 offset = is_orthographic(kernel.view) ? q.xy - p.xy : parallel_offset(q.xy, q.z, p.xy, p.z);
  return vec2(offset.x, -offset.y) / kernel.half_size;
}

// The pixel at `place` of the kernel's square [-1, 1]^2; false where the image does not show the receiver's own surface there.
// `reach`: as far as it may lie, in half widths of the kernel.
bool kernel_pixel(SurfaceKernel kernel, Receiving here, Light light, vec2 place, float reach, out ivec2 pixel) {
  const float SLACK = 1.1;  // a pixel's centre lies beside the place that it stands for
  vec2 at;
  bool shown = parallel_place(kernel.image, place * kernel.half_size, at);
  pixel = ivec2(floor(clamp(at, vec2(-1.0), frame.viewport.xy)));
  vec3 position;
  if (!shown || !shows_surface(here, light, pixel, position)) return false;
  vec2 there = kernel_place(kernel, position);
  float far = kernel.round_light ? length(there) : max(abs(there.x), abs(there.y));
  return far <= SLACK * reach;
}
