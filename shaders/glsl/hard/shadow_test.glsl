// Williams' shadow test (Macedo 2018, eq. 3.2), for the pixels that the depth test leaves: those that show geometry. SHADOWLESS:
// of a light that throws no shadow on what the camera sees.
#include "frame/pixel_rays.glsl"
#include "map/shadow_query.glsl"

layout(location = PIXEL_RAYS) flat in vec4 flat_light[2];
#if LIGHT_VIEWS == 1
layout(location = PIXEL_RAYS + 2) flat in vec4 flat_view[5];
#endif
layout(location = 0) out float out_visibility;

// What the test asks of them.
Light tested_light() {
#if LIGHT_VIEWS > 1
  Light light = lights[push.light];
#else
  Light light;
#endif
  light.position = flat_light[0];
  light.direction = flat_light[1];
  return light;
}

LightView tested_view() {
  LightView view;
#if LIGHT_VIEWS == 1
  for (int i = 0; i < 3; ++i) view.rows[i] = flat_view[i];
  view.range = flat_view[3];
  view.info = uvec4(flat_view[4]);
#endif
  return view;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec3 p = fragment_position(depth_at(at).x);
  vec3 n = octahedral_decode(geometric_at(at).xy);
  Light light = tested_light();
#ifdef SHADOWLESS
  out_visibility = unmapped_visibility(faces_light(light, p, n) ? PIXEL_OUTSIDE : PIXEL_AWAY);
#else
  Query query;
  int state = query_at(p, n, light, tested_view(), query);
  bool lit = is_lit(query, ivec2(floor(query.position)));
  out_visibility = state == PIXEL_INSIDE ? float(lit) : unmapped_visibility(state);
#endif
}
