// Vogel's spiral: points spread evenly over the unit disc. Vogel, A better way to construct the sunflower head, 1979.
// Pure functions.
#ifndef GNOMON_VOGEL_DISC
#define GNOMON_VOGEL_DISC

const float GOLDEN_ANGLE = 2.39996323;  // radians

// Point `i` of `count`, turned by `rotation` radians.
vec2 vogel_point(int i, int count, float rotation) {
  float radius = sqrt((float(i) + 0.5) / float(count));
  float angle = float(i) * GOLDEN_ANGLE + rotation;
  return radius * vec2(cos(angle), sin(angle));
}

// Interleaved gradient noise, in [0, 1): neighbouring pixels get values that differ most. Jimenez, Next generation
// post-processing in Call of Duty: Advanced Warfare, 2014.
float interleaved_gradient_noise(ivec2 pixel) {
  return fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715))));
}

#endif
