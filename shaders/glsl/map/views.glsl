// Which of a light's views shows a point. Uses the buffer `views`, whose order is that of the layers of the light's maps; a pass that
// reads no map has none, and then nothing is outside of one.
#ifndef GNOMON_VIEWS
#define GNOMON_VIEWS

#include "frame/frame.glsl"

#ifdef HAS_VIEWS

// First and number of a light's views.
uvec2 views_of(int light) {
#if VIEWS_COUNT == LIGHT_COUNT  // one each
  return uvec2(light, 1);
#else
  return views[light].info.zw;
#endif
}

bool holds(LightView view, vec3 p) { return view_sees(light_project(view, light_space(view, vec4(p, 1.0)))); }

// The view, of `count` from `first` on, that shows `p`: of a directional light's cascades, the first, and so the finest, that holds
// it, or the last; of a point light's, the one of its major axis (+x -x +y -y +z -z).
uint view_of(Light light, uint first, uint count, vec3 p) {
  if (count == 1u) return first;
  if (is_directional(light)) {
    uint found = count - 1u;
    for (uint i = count - 1u; i > 0u; --i)
      if (holds(views[first + i - 1u], p)) found = i - 1u;
    return first + found;
  }
  vec4 h = vec4(p, 1.0);
  vec3 q = vec3(dot(light.rows[0], h), dot(light.rows[1], h), dot(light.rows[2], h));
  vec3 a = abs(q);
  uint axis = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
  return first + 2 * axis + (q[axis] < 0.0 ? 1 : 0);
}

// The view of a light that shows most: what it does not show, none does.
LightView widest_view(int light) {
  uvec2 range = views_of(light);
  return views[range.x + range.y - 1u];
}

// Does a map of a light with that widest view hold `p`? Beyond it nobody knows of shadows.
bool in_map(Light light, LightView widest, vec3 p) {
#if VIEWS_COUNT != LIGHT_COUNT
  if (light.position.w == LIGHT_POINT || light.position.w == LIGHT_WIDE_SPOT) return true;  // its views see everything
#endif
  return holds(widest, p);
}

#else

LightView widest_view(int light) {
  LightView none;
  return none;
}
bool in_map(Light light, LightView widest, vec3 p) { return true; }

#endif

bool in_map(int light, vec3 p) { return in_map(lights[light], widest_view(light), p); }

#endif
