// What the shaders of bounded_exact share: the radius, and the lists' arguments.

// The radius that the parameters ask for, pixels; the scene may ask for more. Not computed here from the parameters, because lavapipe
// 22.3 crashes when it compiles distance_transform_candidates so.
layout(push_constant) uniform Push { int radius; } push;

const int MOST_PIXELS = 23170;     // diagonal of 16384 x 16384
const int MOST_NEAR_RADIUS = 512;  // for which distance_transform_search keeps a pixel's best in one number

// Words of `candidate_arguments`: the workgroups of the search for small radii and of that for large ones, the candidates' number, and
// how many workgroups are done that list candidates and that search them, so that the last one makes a dispatch of what all have
// listed.
const int NEAR_SEARCH = 0, CANDIDATES = 3, FAR_SEARCH = 4, LISTED_BY = 7, SEARCHED_BY = 8;
bool is_last(uint done_before) { return done_before + 1u == gl_NumWorkGroups.x * gl_NumWorkGroups.y; }

// The radius of bounded_exact in this frame, pixels. Squares of radii up to that of the largest image fit 32 bits.
int frame_radius() {
#if REACHING
  return clamp(int(reached[0]), push.radius, MOST_PIXELS);
#else
  return push.radius;
#endif
}
