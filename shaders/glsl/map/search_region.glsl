// The part of a shadow map that holds all that may hide some of a light from a receiver: it begins with the region that blockers on
// the near plane could be in, and is shrunk to that of the nearest depth in it until it no longer changes, by a min-max pyramid.
// After map/light_kernel.glsl, with a `pyramid`.
const int MOST_STEPS = 4;  // of shrinking; further ones are worth less than the taps tell

struct Region {
  ivec2 low, high;  // first and last texel
  bool blocks;      // may some of it be nearer than the receiver's plane?
  bool all_block;   // is all of it?
  float nearest;    // linear depth that nothing in it is nearer than; NO_BLOCKER: unknown
};

// A blocker is nearer than the receiver, if by little: then a width of 0 says that there is none.
const float LEAST_DISTANCE = 1e-6;  // of the receiver's depth
float blocker_before(Query query, float z_b) { return min(z_b, query.plane.z * (1.0 - LEAST_DISTANCE)); }

Region region_around(vec2 position, vec2 half_width) {
  vec2 most = vec2(map_size());  // beyond which the map's border is repeated anyway
  half_width = min(half_width, most);
  return Region(ivec2(floor(position - half_width)), ivec2(floor(position + half_width)), true, false, NO_BLOCKER);
}

// Of blockers on the near plane. A few blocks of the pyramid tell of most receivers that nothing hides any of the light.
Region first_region(Query query, vec2 half_size, float size) {
  float z_p = query.plane.z, penumbra = max(penumbra_of_blocker(query.view, size, z_p, query.view.range.x), 0.0);
  Region region = region_around(query.position, half_kernel(query.view, half_size, size, penumbra, z_p));
#ifdef HAS_PYRAMID
  float farthest = plane_range(query, region.low, region.high).y;
  region.blocks = blocks(rough_pyramid_range(region.low, region.high, query.layer).x, farthest);
#endif
  return region;
}

#ifdef HAS_PYRAMID
Region find_region(Query query, Light light) {
  LightView view = query.view;
  vec2 half_size = half_size_of(light);
  float z_p = query.plane.z, size = size_of(light), nearest = view.range.x;
  Region region = first_region(query, half_size, size), before;
  if (!region.blocks) return region;
  int steps = 0;
  do {
    before = region;
    vec2 range = pyramid_range(region.low, region.high, query.layer), plane = plane_range(query, region.low, region.high);
    nearest = max(linear_depth(view, range.x), nearest);
    float penumbra = max(penumbra_of_blocker(view, size, z_p, nearest), 0.0);
    region = region_around(query.position, half_kernel(view, half_size, size, penumbra, z_p));
    region.blocks = blocks(range.x, plane.y);
    region.all_block = blocks(range.y, plane.x);
  } while (region.blocks && (region.low != before.low || region.high != before.high) && ++steps < MOST_STEPS);
  region.nearest = nearest;
  return region;
}
#endif
