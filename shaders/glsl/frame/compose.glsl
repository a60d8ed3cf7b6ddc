// Lambertian shading of the G-buffer by all lights, each with its own visibility layer. Linear radiance.
#include "frame/frame.glsl"
#include "lib/octahedral.glsl"
#include "lib/punctual_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const float PI = 3.14159265358979;

// Irradiance of one light at p on a surface with normal n, unshadowed.
vec3 irradiance(Light light, vec3 p, vec3 n) {
  float distance;
  vec3 l = to_light(light, p, distance);
  float e = max(dot(n, l), 0.0);
  if (!is_directional(light)) e *= distance_falloff(distance, light.direction.w);
  if (light.position.w == LIGHT_SPOT) e *= spot_falloff(dot(-l, light.direction.xyz), light.cone.x, light.cone.y);
  return e * light.intensity.rgb;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(color)))) return;
  float device_depth = depth_at(at).x;
  vec3 p = relative_position(at, device_depth);
  vec3 n = octahedral_decode(normal_at(at).xy);
  vec3 sum = vec3(0.0);
#ifdef HAS_VISIBILITY
  for (int i = 0; i < LIGHT_COUNT; ++i) sum += visibility_at(at, i).x * irradiance(lights[i], p, n);
#else
  for (int i = 0; i < LIGHT_COUNT; ++i) sum += irradiance(lights[i], p, n);
#endif
  vec3 radiance = is_background(device_depth) ? vec3(0.0) : albedo_at(at).rgb / PI * sum;
  imageStore(color, at, vec4(radiance, 1.0));
}
