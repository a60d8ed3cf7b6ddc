// Running sums of a map's rows (ROWS), then of its columns, in place (Crow 1984). A workgroup sums 8 lines, each in 8 parts at
// once: every part's total first, then the sums themselves.
//
// Integers wrap: differences of wrapped sums are those of the whole ones as long as they themselves are below 2^32, which the
// scale sees to.
layout(push_constant) uniform Push {
  float factor;  // steps per unit of the source
  uint most;     // steps of the whole range
} push;

const int LINES = 8, PARTS = 8;
layout(local_size_x = LINES, local_size_y = PARTS) in;

#if NUMBERS == NUMBERS_INTEGER_PAIR
#define SUM uvec4
// Whole steps of two values, and what is left of them in as many steps.
SUM stored(vec4 value) {
  precise vec2 steps = clamp((value.xy - params.least) * push.factor, vec2(0.0), vec2(push.most));
  uvec2 whole = uvec2(steps);
  return uvec4(whole, uvec2((steps - vec2(whole)) * float(push.most)));
}
#elif NUMBERS == NUMBERS_INTEGER
#define SUM uvec4
SUM stored(vec4 value) {
  precise vec4 steps = (value - params.least) * push.factor;
  return min(uvec4(max(steps, vec4(0.0)) + 0.5), uvec4(push.most));
}
#else
#define SUM vec4
SUM stored(vec4 value) { return value; }
#endif

shared SUM totals[LINES * PARTS];

ivec3 place(int line, int i) {
#ifdef ROWS
  return ivec3(i, line, gl_WorkGroupID.z);
#else
  return ivec3(line, i, gl_WorkGroupID.z);
#endif
}

SUM value(int line, int i) {
  ivec3 at = place(line, i);
  SUM sum = SUM(0);
#ifdef ROWS
  sum.CHANNELS = stored(source_at(at.xy, at.z)).CHANNELS;
#else
  sum.CHANNELS = imageLoad(sums, at).CHANNELS;
#endif
  return sum;
}

void main() {
  ivec2 size = imageSize(sums).xy;
#ifdef ROWS
  size = size.yx;
#endif
  int line = int(gl_GlobalInvocationID.x), part = int(gl_LocalInvocationID.y);
  int share = (size.y + PARTS - 1) / PARTS, first = part * share, end = min(first + share, size.y);
  if (line >= size.x) end = first;
  SUM sum = SUM(0);
  for (int i = first; i < end; ++i) sum += value(line, i);
  totals[part * LINES + int(gl_LocalInvocationID.x)] = sum;
  barrier();
  sum = SUM(0);
  for (int p = 0; p < part; ++p) sum += totals[p * LINES + int(gl_LocalInvocationID.x)];
  for (int i = first; i < end; ++i) {
    sum += value(line, i);
    imageStore(sums, place(line, i), sum);
  }
}
