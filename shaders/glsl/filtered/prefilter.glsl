// One direction of a separable filter: every invocation writes a band of BAND texels along it, and reads BAND + KERNEL - 1.
//
// Box: no sum is ever subtracted from (van Herk's scheme for running minima, with sums): the windows of a band share their
// middle; each is that, and what is left of the samples before it, and what has come of those after it. A running sum that
// adds on one side and subtracts on the other would keep the rounding errors of all it has passed, and those of an
// exponential basis' bright texels exceed its dark ones by orders of magnitude. Here an error is at most KERNEL roundings of
// the window's own texels, whatever the size of the map.

// Neighbouring invocations: columns side by side, or bands of one row, whose reads share pages and cache lines.
#ifdef ROWS
#define TARGET rows
layout(local_size_x = 8, local_size_y = 8) in;
ivec2 texel(int along, int across) { return ivec2(along, across); }
int length_along(ivec2 size) { return size.x; }
int length_across(ivec2 size) { return size.y; }
#else
#define TARGET result
layout(local_size_x = 64) in;
ivec2 texel(int along, int across) { return ivec2(across, along); }
int length_along(ivec2 size) { return size.y; }
int length_across(ivec2 size) { return size.x; }
#endif

const int RADIUS = KERNEL / 2;
int along_size, across, layer;

vec4 stored(int along) {
  int clamped = clamp(along, 0, along_size - 1);
#ifdef ROWS
  return source_at(texel(clamped, across), layer);
#else
  return imageLoad(rows, ivec3(texel(clamped, across), layer));
#endif
}

void store(int along, vec4 value) {
  if (along < along_size) imageStore(TARGET, ivec3(texel(along, across), layer), value);
}

// A partial sum. In log space: of w e^(c (z - x)), about its largest z, x, so that the largest summand is 1 and no exponent
// overflows.
#if SPACE == SPACE_LOG
#define SUM vec2
SUM none() { return vec2(-1.0, 0.0); }  // depths are not negative
SUM weighed(vec4 value, float w) { return w > 0.0 ? vec2(value.x, w) : none(); }
SUM plus(SUM a, SUM b) {
  float most = max(a.x, b.x);
  return vec2(most, a.y * exp(params.exponent * (a.x - most)) + b.y * exp(params.exponent * (b.x - most)));
}
vec4 finished(SUM s, float weights) { return vec4(min(s.x + log(s.y / weights) / params.exponent, 1.0)); }
#else
#define SUM MOMENTS
SUM none() { return SUM(0.0); }
// Normalised now and not at the end, so that a sum stays within the format's largest number. `precise`: or a compiler takes
// the common factor out of the sum, which then overflows.
SUM weighed(vec4 value, float w) {
  precise SUM part = value.MOMENT_SWIZZLE * (w / float(KERNEL));
  return part;
}
SUM plus(SUM a, SUM b) {
  precise SUM sum = a + b;
  return sum;
}
vec4 finished(SUM s, float weights) {
  vec4 value = vec4(0.0);
  value.MOMENT_SWIZZLE = s * (float(KERNEL) / weights);
  return value;
}
#endif

void filter_band(int first) {
  int start = first - RADIUS;
#if SHAPE == SHAPE_BOX
  SUM before[BAND];  // of window j: its samples before the end of the first window
  SUM sum = none();
  for (int i = KERNEL - 1; i >= BAND - 1; --i) sum = plus(sum, weighed(stored(start + i), 1.0));
  before[BAND - 1] = sum;
  for (int j = BAND - 2; j >= 0; --j) {
    sum = plus(sum, weighed(stored(start + j), 1.0));
    before[j] = sum;
  }
  store(first, finished(before[0], float(KERNEL)));
  SUM after = none();
  for (int j = 1; j < BAND; ++j) {
    after = plus(after, weighed(stored(start + KERNEL - 1 + j), 1.0));
    store(first + j, finished(plus(before[j], after), float(KERNEL)));
  }
#else
  // Each sample is read once and weighed for the BAND windows that hold it.
  const float DEVIATIONS = 0.5 * 4.0;  // from the centre to the border: half the width, of four deviations
  SUM sums[BAND];
  float weights[BAND], totals[BAND];
  for (int j = 0; j < BAND; ++j) sums[j] = none(), weights[j] = 0.0, totals[j] = 0.0;
  for (int i = 0; i < KERNEL + BAND - 1; ++i) {
    vec4 value = stored(start + i);
    for (int j = BAND - 1; j > 0; --j) weights[j] = weights[j - 1];
    float offset = DEVIATIONS * float(i - RADIUS) / (0.5 * float(KERNEL));
    weights[0] = i < KERNEL ? exp(-0.5 * offset * offset) : 0.0;
    for (int j = 0; j < BAND; ++j) {
      totals[j] += weights[j];
      sums[j] = plus(sums[j], weighed(value, weights[j]));
    }
  }
  for (int j = 0; j < BAND; ++j) store(first + j, finished(sums[j], totals[j]));
#endif
}

void main() {
  ivec2 size = imageSize(TARGET).xy;
  along_size = length_along(size);
  ivec2 id = ivec2(gl_GlobalInvocationID.xy);
#ifdef ROWS
  id = id.yx;
#endif
  across = id.x;
  layer = int(gl_GlobalInvocationID.z);
  if (across < length_across(size)) filter_band(id.y * BAND);
}
