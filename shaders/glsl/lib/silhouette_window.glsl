// Silhouette walks of all samples of a filter kernel at once: what RPCF reuses from one sample for its neighbours (Macedo
// 2018, ch. 4.1.2 and algorithm 2). Pure functions on bits.
//
// Samples of one kernel lie whole texels apart, so neighbours on the same silhouette end at the same texels, and a distance
// differs from the previous sample's by the whole texels between them. With the visibility of a window of texels as bits, a
// row's (or column's) distances follow from the position of the nearest bit where the silhouette ends; only a silhouette
// that leaves the window is walked in the map, once for all of the row's samples. The distances are those of rbsm_walk, bit
// for bit.
#ifndef GNOMON_SILHOUETTE_WINDOW
#define GNOMON_SILHOUETTE_WINDOW

struct Run {
  int whole;   // texels passed
  bool found;  // ended at the other visibility
};

// Continuation of silhouettes beyond the window's last texel, for discontinuities on side a, on side b, or on any of both:
// 8 bits of texels passed and one for `found`, each.
const uint RUN_BITS = 9u, RUN_FOUND = 256u, RUN_WHOLE = 255u;

uint pack_run(Run run, uint kind) { return (uint(run.whole) | (run.found ? RUN_FOUND : 0u)) << (RUN_BITS * kind); }

// The continuation for a sample with discontinuities on `side_a` and `side_b`.
Run unpack_run(uint beyond, bool side_a, bool side_b) {
  uint kind = side_a && side_b ? 2u : side_b ? 1u : 0u;
  uint bits = beyond >> (RUN_BITS * kind);
  return Run(int(bits & RUN_WHOLE), (bits & RUN_FOUND) != 0u);
}

Run limit_run(Run run, int max_size) { return run.whole >= max_size ? Run(max_size, false) : run; }

// A line of texels as bits: `same`: has the sample's visibility, `shares`: has a discontinuity that the sample has. The walk
// from bit `at` towards bit 0.
Run run_down(uint same, uint shares, int at, uint beyond, bool side_a, bool side_b, int max_size) {
  uint ends = ~(same & shares) & ((1u << at) - 1u);
  if (ends != 0u) {
    int end = findMSB(ends);
    return limit_run(Run(at - 1 - end, (same >> end & 1u) == 0u), max_size);
  }
  Run run = unpack_run(beyond, side_a, side_b);
  run.whole += at;
  return limit_run(run, max_size);
}

// The walk from bit `at` towards bit `count - 1`, the line's last.
Run run_up(uint same, uint shares, int at, int count, uint beyond, bool side_a, bool side_b, int max_size) {
  uint line = count < 32 ? (1u << count) - 1u : 0xFFFFFFFFu;
  uint ends = ~(same & shares) & line & ~((2u << at) - 1u);
  if (ends != 0u) {
    int end = findLSB(ends);
    return limit_run(Run(end - at - 1, (same >> end & 1u) == 0u), max_size);
  }
  Run run = unpack_run(beyond, side_a, side_b);
  run.whole += count - 1 - at;
  return limit_run(run, max_size);
}

// The signed distance of rbsm_walk.
float run_distance(Run run, float to_border) {
  float distance = float(run.whole) + max(to_border, 1e-6);
  return run.found ? distance : -distance;
}

#endif
