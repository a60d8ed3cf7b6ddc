// Falloff of glTF's punctual lights (KHR_lights_punctual). Pure functions.
#ifndef GNOMON_PUNCTUAL_LIGHT
#define GNOMON_PUNCTUAL_LIGHT

// 1/m^2; `range` 0: unlimited.
float distance_falloff(float distance, float range) {
  float squared = distance * distance, part = squared / max(range * range, 1e-12);
  float window = range > 0.0 ? clamp(1.0 - part * part, 0.0, 1.0) : 1.0;
  return window / squared;
}

// 1 inside the inner cone, 0 outside the outer one. `cosine`: between the spot's axis and the direction from it.
float spot_falloff(float cosine, float cosine_inner, float cosine_outer) {
  float t = clamp((cosine - cosine_outer) / max(cosine_inner - cosine_outer, 1e-4), 0.0, 1.0);
  return t * t;
}

#endif
