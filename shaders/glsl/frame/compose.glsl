// Lambertian shading of the G-buffer by all lights, each with its own visibility layer. Linear radiance. For the pixels that the
// depth test leaves: those that show geometry.
#include "frame/pixel_rays.glsl"
#include "lib/octahedral.glsl"
#include "lib/punctual_light.glsl"

layout(location = PIXEL_RAYS) flat in vec4 flat_lights[4 * FLAT_LIGHTS];
layout(location = 0) out vec4 out_color;

#if SKY
layout(push_constant) uniform Push { vec4 sky; } push;  // radiance
#endif

const float PI = 3.14159265358979;

// What shading asks of it.
Light flat_light(int i) {
  Light light;
  light.position = flat_lights[4 * i];
  light.direction = flat_lights[4 * i + 1];
  light.intensity = flat_lights[4 * i + 2];
  light.cone = flat_lights[4 * i + 3];
  return light;
}

// Irradiance of one light at p on a surface with normal n, unshadowed.
vec3 irradiance(Light light, vec3 p, vec3 n) {
  float distance;
  vec3 l = to_light(light, p, distance);
  float e = max(dot(n, l), 0.0);
  if (!is_directional(light)) e *= distance_falloff(distance, light.direction.w);
  if (has_cone(light)) e *= spot_falloff(dot(-l, light.direction.xyz), light.cone.x, light.cone.y);
  return e * light.intensity.rgb;
}

float seen(ivec2 at, int light) {
#ifdef HAS_VISIBILITY
  return visibility_at(at, light).x;
#else
  return 1.0;
#endif
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec3 p = fragment_position(depth_at(at).x);
  vec3 n = octahedral_decode(normal_at(at).xy);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < FLAT_LIGHTS; ++i) sum += seen(at, i) * irradiance(flat_light(i), p, n);
  for (int i = FLAT_LIGHTS; i < LIGHT_COUNT; ++i) sum += seen(at, i) * irradiance(lights[i], p, n);
#if SKY
  sum += PI * mix(params.ground, 1.0, 0.5 + 0.5 * n.y) * push.sky.rgb;  // hemisphere_irradiance() of engine/light/ambient.h
#endif
  out_color = vec4(albedo_at(at).rgb / PI * sum, 1.0);
}
