// The radius of bounded_exact in this frame, pixels. Squares of radii up to that of the largest image fit 32 bits.
const int MOST_PIXELS = 23170;  // diagonal of 16384 x 16384
const int MOST_NEAR_RADIUS = 512;  // for which distance_transform_search keeps a pixel's best in one number
int frame_radius() {
  int least = max(params.radius, int(ceil(0.5 * params.pixels)));
#if REACHING
  return clamp(int(reached[0]), least, MOST_PIXELS);
#else
  return least;
#endif
}
