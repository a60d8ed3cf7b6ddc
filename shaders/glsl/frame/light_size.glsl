// Sizes of lights, as lights[] has them, and what a receiver sees of them.
#ifndef GNOMON_LIGHT_SIZE
#define GNOMON_LIGHT_SIZE

#include "frame/frame.glsl"
#include "lib/light_horizon.glsl"

// Half width and height of the light: world units; of a directional light, tangents.
vec2 half_size_of(Light light) { return is_directional(light) ? vec2(light.size.w) : light.size.xy; }
// Its larger side, by which widths of penumbrae count.
float size_of(Light light) {
  vec2 half_size = half_size_of(light);
  return 2.0 * max(half_size.x, half_size.y);
}
bool is_round(Light light) { return light.size.z == SHAPE_DISC || light.size.z == SHAPE_SPHERE; }

// What the tangent plane of a receiver hides of the light, whose shape is scaled to the square [-1, 1]^2. `view`: one of the light's;
// `position`: relative; `normal`: geometric.
Horizon receiver_horizon(LightView view, vec3 position, vec3 normal, vec2 half_size) {
  vec3 n = light_space(view, vec4(normal, 0.0));
  if (is_orthographic(view)) return directional_horizon(n, half_size);
  return horizon_of(light_space(view, vec4(position, 1.0)), n, half_size);
}
float share_above(Horizon horizon, bool round_light) { return round_light ? disc_above(horizon) : square_above(horizon); }

#endif
