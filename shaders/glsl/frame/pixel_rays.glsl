// The camera's rays for a full-screen pass, as flat inputs of its fragments, which the vertex shader makes (PIXEL_RAYS_OUT).
// Software devices read what is in a uniform buffer number by number, with a check each, for every few fragments; flat inputs
// cost them next to nothing.
#include "frame/frame.glsl"

const int PIXEL_RAYS = 3;  // locations, from 0

#ifdef PIXEL_RAYS_OUT
layout(location = 0) flat out vec4 pixel_rays[PIXEL_RAYS];

void make_pixel_rays() {
  pixel_rays[0] = vec4(frame.ray_corner.xyz, frame.depth.x);
  pixel_rays[1] = vec4(frame.ray_dx.xyz, frame.depth.y);
  pixel_rays[2] = vec4(frame.ray_dy.xyz, 0.0);
}

// One triangle at the far plane: with a depth test for what lies before it, it covers all pixels but the background.
vec4 triangle_behind_all() {
  float far = frame.depth.y != 0.0 ? 0.0 : 1.0;
  return vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, far, 1.0);
}
#else
layout(location = 0) flat in vec4 pixel_rays[PIXEL_RAYS];

// As relative_position() of frame.glsl, for the fragment's pixel.
#ifdef ORTHOGRAPHIC_CAMERA
vec3 fragment_position(float device_depth) { return relative_position(ivec2(gl_FragCoord.xy), device_depth); }
#else
vec3 fragment_position(float device_depth) {
  float z = pixel_rays[0].w / (pixel_rays[1].w != 0.0 ? device_depth : 1.0 - device_depth);
  return z * (pixel_rays[0].xyz + gl_FragCoord.x * pixel_rays[1].xyz + gl_FragCoord.y * pixel_rays[2].xyz);
}
#endif
#endif
