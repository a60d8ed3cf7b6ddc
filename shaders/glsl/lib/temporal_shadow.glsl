// Shadow tests of one area-light sample a frame, kept from frame to frame. Pure functions.
// Schwärzler 2009, "Real-Time Soft Shadows with Temporal Coherence", ch. 5; equation numbers are those of that text.
#ifndef GNOMON_TEMPORAL_SHADOW
#define GNOMON_TEMPORAL_SHADOW

const float BLOCKER_NONE = 0.0;      // no blocker has been seen
const float BLOCKER_UNKNOWN = -1.0;  // to be searched for

struct ShadowHistory {
  float shadowed;  // rho: tests that found the pixel in shadow, weighted by their samples' emission
  float tests;     // eta: all tests, weighted likewise; 0: none, or another surface
  float depth;     // view depth of the surface, world units
  float blocker;   // mean distance of blockers along the light's axis, world units, or BLOCKER_*
  bool moving;     // some of the shadow is of a caster that moves
};

ShadowHistory no_history(float depth) { return ShadowHistory(0.0, 0.0, depth, BLOCKER_UNKNOWN, false); }

// The depth's sign tells shadows of moving casters (section 5.2.5).
vec4 pack_history(ShadowHistory h) { return vec4(h.shadowed, h.tests, h.moving ? -h.depth : h.depth, h.blocker); }
ShadowHistory unpack_history(vec4 v) { return ShadowHistory(v.x, v.y, abs(v.z), v.w, v.z < 0.0); }

// Share of the light that is hidden (5.2), and the rest of it: sums of tests are exact, and so is their difference.
float hidden_share(ShadowHistory h) { return h.tests > 0.0 ? h.shadowed / h.tests : 0.0; }
float seen_share(ShadowHistory h) { return h.tests > 0.0 ? (h.tests - h.shadowed) / h.tests : 1.0; }

// Standard error of `hidden`, the share of `tests` independent tests (5.3); 1 where fewer than two tell nothing.
float standard_error(float hidden, float tests) {
  return tests > 1.0 ? sqrt(max(hidden * (1.0 - hidden), 0.0) / (tests - 1.0)) : 1.0;
}

// How much of the tests' share to use rather than of the spatial filter's (5.13): the filter alone below `least` tests.
float tests_weight(ShadowHistory h, float s_min, float s_max, float least) {
  float error = standard_error(hidden_share(h), h.tests);
  return h.tests < least ? 0.0 : clamp((s_max - error) / (s_max - s_min), 0.0, 1.0);
}

// Are two view depths those of one surface (5.18)?
bool same_depth(float a, float b, float tolerance) { return abs(b - a) < tolerance * b; }

// The same share of fewer tests.
ShadowHistory with_tests(ShadowHistory h, float tests) {
  h.shadowed = tests * hidden_share(h);
  h.tests = tests;
  return h;
}
ShadowHistory limit_tests(ShadowHistory h, float most) {
  if (h.tests <= most) return h;  // exact
  return with_tests(h, most);
}

// What a moving caster's shadow leaves behind (5.15)-(5.17): at most `most` tests, `delta` fewer each frame.
ShadowHistory fade(ShadowHistory h, float most, float delta) {
  return with_tests(h, max(min(h.tests, most) - delta, 0.0));
}

// One more test (5.5).
ShadowHistory add_test(ShadowHistory h, bool shadowed, float weight) {
  h.shadowed += shadowed ? weight : 0.0;
  h.tests += weight;
  return h;
}

// Mean blocker distance with one more blocker at `depth` (5.7)-(5.8). `h`: before its test; `searched`: blockers looked at when
// the pixel was new.
float add_blocker(ShadowHistory h, float depth, float searched) {
  if (h.blocker <= BLOCKER_NONE) return depth;
  float before = h.tests + searched;
  return (depth + h.blocker * before) / (before + 1.0);
}

// Width of the penumbra on the receiver, world units (5.6). Distances along the light's axis.
float penumbra_width(float receiver, float blocker, float light_size) {
  return blocker > 0.0 ? max(receiver - blocker, 0.0) / blocker * light_size : 0.0;
}

#endif
