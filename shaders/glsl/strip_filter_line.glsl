// Separable filters: one strip of the image, 64 pixels along the filter's direction and 8 across, with what the filter reaches
// at both ends. Included by the filters after they are told the direction (ALONG_Y_AXIS).
#include "strip_filter.glsl"

layout(local_size_x = 8, local_size_y = 8) in;  // x: line of the strip; y: part of the line

const int LINES = 8, PARTS = 8;
const int SPAN = LENGTH + 2 * MAX_HALF + 2;   // places of a line at most; one spare at each end
const int EDGE_WORDS = (SPAN + 31) / 32;

shared uint edges[LINES * EDGE_WORDS];  // bit p of a line: there is an edge between its places p - 1 and p

#ifdef ALONG_Y_AXIS
const ivec2 ALONG = ivec2(0, 1);
#else
const ivec2 ALONG = ivec2(1, 0);
#endif

int line() { return int(gl_LocalInvocationID.x); }
int part() { return int(gl_LocalInvocationID.y); }

// False for workgroups beyond the list's end. `origin`: the strip's first pixel.
bool strip_at(out ivec2 origin, out int light) {
  uint index = tile_index(gl_WorkGroupID);
#ifdef ALONG_Y_AXIS
  bool listed = index < control[ALONG_Y + 3];
  uint packed = listed ? strips_y[index] : 0u;
#else
  bool listed = index < control[ALONG_X + 3];
  uint packed = listed ? strips_x[index] : 0u;
#endif
  ivec2 strip = unpack_tile(packed).origin / TILE;
  origin = strip * (ALONG * LENGTH + ALONG.yx * CELL);
  light = unpack_tile(packed).layer;
  return listed;
}

// Places run from `reach + 1` before the strip to as many behind it.
ivec2 pixel_of(ivec2 origin, int reach, int place) { return origin + ALONG * (place - reach - 1) + ALONG.yx * line(); }

float source_at(ivec2 pixel, int light) {
  ivec3 at = ivec3(clamp(pixel, ivec2(0), image_size() - 1), light);
#ifdef ALONG_Y_AXIS
  return imageLoad(rows, at).x;
#else
  return imageLoad(visibility, at).x;
#endif
}

void store(ivec2 pixel, int light, float v) {
  if (any(greaterThanEqual(pixel, image_size()))) return;
#ifdef ALONG_Y_AXIS
  imageStore(visibility, ivec3(pixel, light), vec4(v));
#else
  imageStore(rows, ivec3(pixel, light), vec4(v));
#endif
}

void clear_edges() {
  for (int i = int(gl_LocalInvocationIndex); i < LINES * EDGE_WORDS; i += LINES * PARTS) edges[i] = 0u;
}
void set_edge(int place) { atomicOr(edges[line() * EDGE_WORDS + place / 32], 1u << uint(place % 32)); }

// The place of the last edge at or before `place`, or `limit` where that is nearer.
int window_begin(int place, int limit) {
  int begin = limit;
  for (int word = max(limit, 0) / 32; word <= place / 32; ++word) {
    uint bits = edges[line() * EDGE_WORDS + word];
    if (word == place / 32) bits &= 0xFFFFFFFFu >> uint(31 - place % 32);
    if (bits != 0u) begin = max(begin, word * 32 + findMSB(bits));
  }
  return begin;
}
// The last place before the next edge after `place`, or `limit` where that is nearer.
int window_end(int place, int limit) {
  int end = limit;
  for (int word = min(limit + 1, SPAN - 1) / 32; word >= (place + 1) / 32; --word) {
    uint bits = edges[line() * EDGE_WORDS + word];
    if (word == (place + 1) / 32) bits &= 0xFFFFFFFFu << uint((place + 1) % 32);
    if (bits != 0u) end = min(end, word * 32 + findLSB(bits) - 1);
  }
  return end;
}
