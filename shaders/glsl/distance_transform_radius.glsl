// The radius of bounded_exact in this frame, pixels. Squares of radii up to that of the largest image fit 32 bits.
const int MOST_PIXELS = 23170;  // diagonal of 16384 x 16384
int frame_radius() {
#if REACHING
  return clamp(int(reached[0]), params.radius, MOST_PIXELS);
#else
  return params.radius;
#endif
}
