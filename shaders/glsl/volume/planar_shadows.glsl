// What the shaders of planar shadows share. Mirrors Push of passes/volume/planar_shadows.cpp.
#ifndef GNOMON_PLANAR_SHADOWS
#define GNOMON_PLANAR_SHADOWS

#include "frame/frame.glsl"

layout(push_constant) uniform Push {
  uint instance, material;
  uint light;
  float tolerance;  // world units: what lies nearer to the plane than this lies on it
  vec4 plane;       // relative: dot(plane, (p, 1)) is the height over the receiver, on the light's side
} push;

// The light as a homogeneous point, at infinity for directional lights.
vec4 light_point(Light light) {
  return is_directional(light) ? vec4(-light.direction.xyz, 0.0) : vec4(light.position.xyz, 1.0);
}

#endif
