// The part of a shadow map that holds all that may hide some of a light from a receiver: it begins with the region that blockers on
// the near plane could be in, and is shrunk to that of the nearest depth in it until it no longer changes, by a min-max pyramid.
// After map/light_kernel.glsl, with a `pyramid`.
const int MOST_STEPS = 16;  // of shrinking; the last ones are worth parts of a texel

struct Region {
  ivec2 low, high;  // first and last texel
  bool blocks;      // may some of it be nearer than the receiver's plane?
  float nearest;    // linear depth that nothing in it is nearer than; NO_BLOCKER: unknown
};

Region region_around(vec2 position, vec2 half_width) {
  vec2 most = vec2(map_size());  // beyond which the map's border is repeated anyway
  half_width = min(half_width, most);
  return Region(ivec2(floor(position - half_width)), ivec2(floor(position + half_width)), true, NO_BLOCKER);
}

#ifdef HAS_PYRAMID
Region find_region(Query query, Light light) {
  LightView view = query.view;
  vec2 half_size = half_size_of(light);
  float z_p = query.plane.z, size = size_of(light), nearest = view.range.x;
  Region region = region_around(query.position, vec2(0.0)), before;
  int steps = 0;
  do {
    before = region;
    float penumbra = max(penumbra_of_blocker(view, size, z_p, nearest), 0.0);
    region = region_around(query.position, half_kernel(view, half_size, size, penumbra, z_p));
    vec2 range = pyramid_range(region.low, region.high, query.layer);
    region.blocks = blocks(range.x, plane_range(query, region.low, region.high).y);
    nearest = max(linear_depth(view, range.x), nearest);
  } while (region.blocks && (region.low != before.low || region.high != before.high) && ++steps < MOST_STEPS);
  region.nearest = nearest;
  return region;
}
#endif
