// The screen-space kernel of a penumbra in its exact form: where the image shows what an offset in the plane through a receiver
// parallel to the light meets of the receiver's tangent plane, along the ray from the light's centre. (G8) is its derivative.
// Pure functions.
#ifndef GNOMON_LIGHT_PARALLEL
#define GNOMON_LIGHT_PARALLEL

// Homogeneous places in the image, in pixels: of the receiver itself, and what a unit of offset along two axes adds.
struct ParallelImage {
  vec3 origin, along_x, along_y;
};

// Homogeneous: the point of the tangent plane of `p` (unit normal `n`) on the ray through the light's centre and p + o is
// (p, 1) plus this. `light`: the centre; of a directional light the way it shines.
vec4 slide_to_plane(vec3 o, vec3 n, vec3 p, vec3 light, bool directional) {
  if (directional) return vec4(o - light * (dot(n, o) / dot(n, light)), 0.0);
  float share = dot(n, o) / dot(n, p - light);
  return vec4(o + light * share, share);
}

// `x`, `y`: unit axes of the light. `clip`: of the camera, from the space of `p`. `viewport`: pixels.
ParallelImage parallel_image(mat4 clip, vec2 viewport, vec3 p, vec3 n, vec3 light, bool directional, vec3 x, vec3 y) {
  vec4 corners[3] = vec4[3](clip * vec4(p, 1.0), clip * slide_to_plane(x, n, p, light, directional),
                            clip * slide_to_plane(y, n, p, light, directional));
  vec3 places[3];
  for (int i = 0; i < 3; ++i) places[i] = vec3(0.5 * viewport * (corners[i].xy + corners[i].w), corners[i].w);
  return ParallelImage(places[0], places[1], places[2]);
}

// Place of the offset `o`, pixels; false: behind the camera, or beyond the receiver's horizon.
bool parallel_place(ParallelImage image, vec2 o, out vec2 place) {
  vec3 homogeneous = image.origin + o.x * image.along_x + o.y * image.along_y;
  place = homogeneous.xy / homogeneous.z;
  return homogeneous.z > 0.0;
}

#endif
